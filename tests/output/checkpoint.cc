// SPDX-License-Identifier: LGPL-2.1-or-later
// Checkpoints that somebody has changed, with a sound checksum: nothing in them is trusted.
#include "billet/output/checkpoint.h"

#include "../testing.h"

#include "billet/errors.h"

#include <deal.II/base/mpi.h>

#include <boost/crc.hpp>

#include <hdf5.h>

#include <fstream>
#include <functional>
#include <iomanip>
#include <sstream>

namespace checkpoint_test {

using namespace billet;
using billet::testing::check;

namespace {

const std::string file_name = "changed.h5";

void write(const std::function<void(CheckpointWriter &)> &save) {
  CheckpointWriter writer(MPI_COMM_WORLD, file_name);
  save(writer);
  check("a checkpoint is written", writer.finish().empty());
}

/// Returns the message of a refusal; empty if reading succeeds.
std::string refusal(const std::function<void(CheckpointReader &)> &load) {
  try {
    CheckpointReader reader(MPI_COMM_WORLD, file_name, "scene.prm:1");
    reader.load("part", [&] { load(reader); });
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

bool has(const std::string &text, const std::string &part) { return text.find(part) != std::string::npos; }

parameters::Output output_to(const std::string &folder) {
  parameters::Output output;
  output.folder.value = folder;
  output.checkpoint.keep = 2;
  return output;
}

/// Names of checkpoints before it, which later ones replace.
std::string load_names(const std::string &names) {
  write([&](CheckpointWriter &writer) {
    writer.in("part", [&] {
      writer.write_text("checkpoints", names);
      writer.write("checkpoints written", {3.});
    });
  });
  return refusal(
      [](CheckpointReader &reader) { Checkpoints(output_to("."), MPI_COMM_WORLD).load(reader, 0., true); });
}

void check_names() {
  check("names of checkpoints are read", load_names("checkpoint_00001.h5\ncheckpoint_123456.h5\n").empty());
  for (const std::string name : {"scene.prm", "../checkpoint_00001.h5", "/checkpoint_00001.h5",
                                 "checkpoint_1.h5", "checkpoint_00001.h5.old"}) {
    const std::string message = load_names("checkpoint_00001.h5\n" + name + "\n");
    check(name + " is none",
          has(message, "'" + file_name + "' does not match this scene: it names '" + name + "'"));
  }
}

void check_counts() {
  write([](CheckpointWriter &writer) {
    writer.in("part", [&] {
      writer.write("two", {1., 2.});
      writer.write("fraction", {1.5});
      writer.write("negative", {-1.});
      writer.write("large", {1e12});
      writer.write("number", {std::nan("")});
      writer.write("count", {4294967295.});
      writer.write_rows("list size", 1, {0, 1}, {1e12, 2.});
      writer.write_rows("list", 1, {0, std::uint64_t{1} << 40U, (std::uint64_t{1} << 40U) + 1}, {5., 6., 7.});
    });
  });
  const auto refuses = [](const std::string &part,
                          const std::function<void(const CheckpointReader &)> &load) {
    return has(refusal(load), part);
  };
  check("a list of another size", refuses("'two' has 2 numbers, expected are 3",
                                          [](const CheckpointReader &reader) { reader.read("two", 3); }));
  check("a list in place of a number", refuses("'two' has 2 numbers, expected are 1",
                                               [](const CheckpointReader &reader) { reader.number("two"); }));
  for (const std::string name : {"fraction", "negative", "large", "number"})
    check(name + " is no count", refuses("is no whole number from 0 to 4294967295",
                                         [&](const CheckpointReader &reader) { reader.count(name); }));
  check("a count", refusal([](const CheckpointReader &reader) {
                     check("its value", reader.count("count") == 4294967295U);
                   }).empty());
  check("beyond the end of a list", refuses("a list that is too short", [](const CheckpointReader &reader) {
          const std::vector<double> two = reader.read("two");
          RowReader row(two);
          for (unsigned int i = 0; i < 3; ++i)
            row.number();
        }));
  check("a list longer than the file",
        refuses("lacks", [](const CheckpointReader &reader) { read_list(reader, "list", 0); }));
  check("a list", refusal([](const CheckpointReader &reader) {
                    check("its numbers", read_list(reader, "list", 1) == std::vector<double>({6., 7.}));
                  }).empty());
}

/// Changes the file and gives it the size and checksum of the result.
void change(const std::function<void(hid_t)> &action) {
  const hid_t file = H5Fopen(file_name.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  action(file);
  H5Fclose(file);
  std::ostringstream text;
  text << std::ifstream(file_name, std::ios::binary).rdbuf();
  std::string bytes = text.str();
  constexpr std::size_t header_size = 512;
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data() + header_size, bytes.size() - header_size);
  std::ostringstream header;
  header << bytes.substr(0, bytes.find("bytes ")) << "bytes " << bytes.size() << "\nchecksum " << std::hex
         << std::setfill('0') << std::setw(8) << crc.checksum() << "\n";
  bytes.replace(0, header.str().size(), header.str());
  std::ofstream(file_name, std::ios::binary) << bytes;
}

void make_array(const hid_t file, const std::string &name, const std::vector<hsize_t> &size) {
  const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
  const hid_t set =
      H5Dcreate2(file, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dclose(set);
  H5Sclose(space);
}

void check_tables() {
  write([](CheckpointWriter &writer) {
    writer.in("part", [&] { writer.write_rows("rows", 1, {1, 2}, {1., 2.}); });
  });
  change([](const hid_t file) {
    make_array(file, "part/huge", {1000000, 1000000}); // it has no numbers in the file
    make_array(file, "part/cube", {1, 1, 1});
    H5Ldelete(file, "part/rows/rows", H5P_DEFAULT);
  });
  const auto refuses = [](const std::string &name, const std::string &part) {
    return has(refusal([&](const CheckpointReader &reader) { reader.read(name); }), part);
  };
  check("a table larger than the file", refuses("huge", "'part/huge' is incomplete"));
  check("a table of three dimensions", refuses("cube", "'part/cube' is no table"));
  check("keys without rows",
        has(refusal([](const CheckpointReader &reader) { reader.read_rows("rows", 1, {1}, nullptr); }),
            "it has no 'part/rows/rows'"));
  change([](const hid_t file) { make_array(file, "part/rows/rows", {0, 1}); });
  check("fewer rows than keys",
        has(refusal([](const CheckpointReader &reader) { reader.read_rows("rows", 1, {1}, nullptr); }),
            "has 0 rows for 2 nodes or elements"));
}

} // namespace

BILLET_MPI_TEST(checkpoint) {
  check_names();
  check_counts();
  check_tables();
}

} // namespace checkpoint_test
