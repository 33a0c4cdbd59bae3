// SPDX-License-Identifier: LGPL-2.1-or-later
// Checkpoints: none is accepted whose size or checksum is not that of its header. Those with a sound checksum
// and false content are in output/checkpoint.
#include "fuzz.h"

#include "billet/errors.h"
#include "billet/output/checkpoint.h"

#include <deal.II/base/mpi.h>

#include <boost/crc.hpp>

#include <iomanip>

namespace checkpoint_test {

using namespace billet;
using namespace billet::testing;

namespace {

constexpr std::size_t header_size = 512;

void start() {
  static int argc = 0;
  static char **argv = nullptr;
  static const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
}

/// Whether size and checksum are those of the header, by the bytes alone.
bool is_sound(const std::string &bytes) {
  std::istringstream words(bytes.substr(0, header_size));
  std::string word, sum;
  std::size_t size = 0;
  while (words >> word && word != "bytes") {
  }
  words >> size >> word >> sum;
  if (bytes.size() < header_size || size != bytes.size() || word != "checksum")
    return false;
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data() + header_size, bytes.size() - header_size);
  std::ostringstream text;
  text << std::hex << std::setfill('0') << std::setw(8) << crc.checksum();
  return text.str() == sum;
}

} // namespace

std::map<std::string, std::string> corpus() {
  start();
  CheckpointWriter writer(MPI_COMM_WORLD, "sound.h5");
  writer.write("time", {0.5});
  writer.in("body 0", [&] {
    writer.write_text("name", "billet");
    writer.write_rows("displacements", 3, {1, 2}, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  });
  check("a checkpoint is written", writer.finish().empty());
  return {{"checkpoint.h5", bytes_of("sound.h5")}};
}

Outcome judge(const std::string &bytes) {
  start();
  write_bytes("damaged.h5", bytes);
  try {
    CheckpointReader reader(MPI_COMM_WORLD, "damaged.h5", "scene.prm:1");
    if (!is_sound(bytes))
      return Outcome::unsound;
    bool is_read = reader.read("time") == std::vector<double>{0.5};
    reader.load("body 0", [&] {
      is_read = is_read && reader.read_text("name") == "billet" &&
                reader.read_rows("displacements", 3, {2}, nullptr) == std::vector<double>({0.4, 0.5, 0.6});
    });
    return is_read ? Outcome::accepted : Outcome::unsound;
  } catch (const InputError &error) {
    return is_message(error.what()) ? Outcome::refused : Outcome::unsound;
  }
}

BILLET_FUZZ_TARGET(checkpoint)

} // namespace checkpoint_test
