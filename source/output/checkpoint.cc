// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/checkpoint.h"

#include "billet/algebra/gather.h"
#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/times.h"
#include "billet/usage.h"
#include "billet/version.h"

#include <deal.II/base/mpi.h>

#include <boost/crc.hpp>

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <regex>
#include <sstream>

namespace billet {

namespace {

constexpr std::size_t header_size = 512; // the user block of HDF5
constexpr std::size_t n_at_once = std::size_t{1} << 20U;
const std::string magic = "billet checkpoint";

// HDF5's identifiers are 64 bits wide, as a long is here.
static_assert(sizeof(hid_t) <= sizeof(long), "identifiers are kept as long");

/// Owner of an HDF5 identifier; closes it.
class CheckpointHandle {
public:
  using Close = herr_t (*)(hid_t);
  CheckpointHandle(const hid_t id, const Close close) : id_(id), close_(close) {}
  ~CheckpointHandle() {
    if (id_ >= 0)
      close_(id_);
  }
  CheckpointHandle(const CheckpointHandle &) = delete;
  CheckpointHandle &operator=(const CheckpointHandle &) = delete;

  bool is_open() const { return id_ >= 0; }
  hid_t id() const { return id_; }

private:
  hid_t id_;
  Close close_;
};

/// Disables HDF5's own error messages: those of this file name the problem.
void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

/// Returns the checksum of all bytes after the header.
std::string checksum(std::ifstream &in) {
  boost::crc_32_type crc;
  std::vector<char> buffer(n_at_once);
  in.clear();
  in.seekg(header_size);
  while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || in.gcount() > 0)
    crc.process_bytes(buffer.data(), static_cast<std::size_t>(in.gcount()));
  std::ostringstream text;
  text << std::hex << std::setfill('0') << std::setw(8) << crc.checksum();
  return text.str();
}

std::uintmax_t size_of(const std::string &file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? 0 : size;
}

std::string last_error() { return std::strerror(errno); }

/// Flushes a file, or the file list of a folder, to disk. Returns whether that succeeded.
bool synchronise(const std::string &name, const int flags) {
  const int descriptor = open(name.c_str(), flags);
  if (descriptor < 0)
    return false;
  const bool success = fsync(descriptor) == 0;
  return close(descriptor) == 0 && success;
}

std::string folder_of(const std::string &file) {
  const auto folder = std::filesystem::path(file).parent_path();
  return folder.empty() ? "." : folder.string();
}

} // namespace

// --- writing -------------------------------------------------------------------------------------

namespace {

// Space that HDF5 may need in addition to the data, at any time until the file is closed.
constexpr std::size_t reserve_of_hdf5 = std::size_t{1} << 18U;

} // namespace

CheckpointWriter::CheckpointWriter(MPI_Comm communicator, std::string file_name)
    : communicator_(communicator), is_first_(dealii::Utilities::MPI::this_mpi_process(communicator) == 0),
      name_(std::move(file_name)) {
  if (is_first_) {
    silence_hdf5();
    std::ofstream(name_ + ".tmp", std::ios::trunc).close();
    if (reserve(0)) {
      const CheckpointHandle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
      H5Pset_userblock(creation.id(), header_size);
      file_ = H5Fcreate((name_ + ".tmp").c_str(), H5F_ACC_TRUNC, creation.id(), H5P_DEFAULT);
      if (check(file_ >= 0, "cannot be made"))
        reserve(0); // again, since the file was truncated
    }
  }
  write("ranks", {static_cast<double>(dealii::Utilities::MPI::n_mpi_processes(communicator))});
}

CheckpointWriter::~CheckpointWriter() {
  if (!is_first_)
    return;
  close();
  std::error_code ignored;
  std::filesystem::remove(name_ + ".tmp", ignored);
}

void CheckpointWriter::close() {
  if (file_ >= 0)
    check(H5Fclose(file_) >= 0, "cannot be closed");
  file_ = -1;
}

bool CheckpointWriter::reserve(const std::size_t n_bytes) {
  // HDF5 cannot recover from a failed write: it crashes, at the end of the program at the latest.
  hsize_t size = 0;
  if (file_ >= 0)
    H5Fget_filesize(file_, &size);
  const int descriptor = open((name_ + ".tmp").c_str(), O_RDWR);
  if (!check(descriptor >= 0, "cannot be made"))
    return false;
  const int error = posix_fallocate(descriptor, 0, static_cast<off_t>(size + n_bytes + reserve_of_hdf5));
  ::close(descriptor);
  return check(error == 0, "cannot be extended to its full size");
}

bool CheckpointWriter::check(const bool success, const std::string &what) {
  if (!success && failure_.empty())
    failure_ = name_ + ".tmp " + what;
  return failure_.empty();
}

void CheckpointWriter::enter(const std::string &name) {
  group_ += name + "/";
  if (is_first_ && failure_.empty()) {
    const CheckpointHandle made(H5Gcreate2(file_, group_.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                H5Gclose);
    check(made.is_open(), "cannot be written");
  }
}

void CheckpointWriter::leave() {
  group_.pop_back();
  group_.resize(group_.rfind('/') == std::string::npos ? 0 : group_.rfind('/') + 1);
}

void CheckpointWriter::write_array(const std::string &name, const long type, const std::size_t n_rows,
                                   const std::size_t width, const void *values) {
  if (!reserve(n_rows * width * H5Tget_size(type)))
    return;
  const std::array<hsize_t, 2> size{n_rows, width};
  const CheckpointHandle space(H5Screate_simple(2, size.data(), nullptr), H5Sclose);
  const CheckpointHandle set(
      H5Dcreate2(file_, (group_ + name).c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  if (check(set.is_open(), "cannot be written") && values != nullptr && n_rows * width > 0)
    check(H5Dwrite(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0, "cannot be written");
}

void CheckpointWriter::write(const std::string &name, const std::vector<double> &values) {
  if (is_first_ && failure_.empty())
    write_array(name, H5T_NATIVE_DOUBLE, 1, values.size(), values.data());
}

void CheckpointWriter::write_text(const std::string &name, const std::string &text) {
  if (is_first_ && failure_.empty())
    write_array(name, H5T_NATIVE_CHAR, 1, text.size(), text.data());
}

void CheckpointWriter::write_rows(const std::string &name, const std::size_t width,
                                  const std::vector<std::uint64_t> &keys, const std::vector<double> &values) {
  const std::uint64_t n_own = keys.size();
  const auto counts = all_gather(communicator_, n_own);
  std::uint64_t n_rows = 0;
  for (const auto count : counts)
    n_rows += count;
  enter(name);
  if (is_first_ && failure_.empty()) {
    write_array("keys", H5T_NATIVE_UINT64, n_rows, 1, nullptr);
    write_array("rows", H5T_NATIVE_DOUBLE, n_rows, width, nullptr);
  }
  // The first rank collects the rows of all ranks in blocks, in the order of the ranks.
  const std::size_t n_part = std::max<std::size_t>(1, n_at_once / width);
  const auto put = [&](const std::string &what, const long type, const std::uint64_t begin,
                       const std::size_t n, const std::size_t columns, const void *data) {
    if (!failure_.empty())
      return;
    const CheckpointHandle set(H5Dopen2(file_, (group_ + what).c_str(), H5P_DEFAULT), H5Dclose);
    const CheckpointHandle space(H5Dget_space(set.id()), H5Sclose);
    const std::array<hsize_t, 2> start{begin, 0}, count{n, columns};
    const CheckpointHandle memory(H5Screate_simple(2, count.data(), nullptr), H5Sclose);
    check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) >=
                  0 &&
              H5Dwrite(set.id(), type, memory.id(), space.id(), H5P_DEFAULT, data) >= 0,
          "cannot be written");
  };
  constexpr int tag = 73;
  std::uint64_t begin = 0;
  std::vector<std::uint64_t> other_keys;
  std::vector<double> other_values;
  for (unsigned int rank = 0; rank < counts.size(); ++rank)
    for (std::uint64_t done = 0; done < counts[rank]; done += n_part) {
      const std::size_t n = std::min<std::uint64_t>(n_part, counts[rank] - done);
      const auto n_keys = static_cast<int>(n), n_values = static_cast<int>(n * width);
      if (is_first_) {
        const std::uint64_t *these_keys = keys.data() + done;
        const double *these_values = values.data() + done * width;
        if (rank > 0) {
          other_keys.resize(n);
          other_values.resize(n * width);
          MPI_Recv(other_keys.data(), n_keys, MPI_UINT64_T, static_cast<int>(rank), tag, communicator_,
                   MPI_STATUS_IGNORE);
          MPI_Recv(other_values.data(), n_values, MPI_DOUBLE, static_cast<int>(rank), tag, communicator_,
                   MPI_STATUS_IGNORE);
          these_keys = other_keys.data();
          these_values = other_values.data();
        }
        put("keys", H5T_NATIVE_UINT64, begin, n, 1, these_keys);
        put("rows", H5T_NATIVE_DOUBLE, begin, n, width, these_values);
        begin += n;
      } else if (rank == dealii::Utilities::MPI::this_mpi_process(communicator_)) {
        MPI_Send(keys.data() + done, n_keys, MPI_UINT64_T, 0, tag, communicator_);
        MPI_Send(values.data() + done * width, n_values, MPI_DOUBLE, 0, tag, communicator_);
      }
    }
  leave();
}

std::string CheckpointWriter::seal() const {
  const std::string draft = name_ + ".tmp";
  std::ifstream in(draft, std::ios::binary);
  std::ostringstream header;
  header << magic << "\nformat " << checkpoint_format << "\nprogram " << version << "\nbytes "
         << size_of(draft) << "\nchecksum " << checksum(in) << "\n";
  in.close();
  std::fstream out(draft, std::ios::in | std::ios::out | std::ios::binary);
  out << header.str();
  out.close();
  if (!out || !synchronise(draft, O_RDWR))
    return draft + " cannot be written: " + last_error();
  if (std::rename(draft.c_str(), name_.c_str()) != 0)
    return draft + " cannot be renamed: " + last_error();
  synchronise(folder_of(name_), O_RDONLY);
  return "";
}

std::string CheckpointWriter::finish() {
  if (is_first_) {
    close();
    if (failure_.empty())
      failure_ = seal();
  }
  return dealii::Utilities::MPI::broadcast(communicator_, failure_, 0);
}

// --- reading -------------------------------------------------------------------------------------

namespace {

/// Returns why a run cannot resume from the file; empty if it can.
std::string find_fault(const std::string &name) {
  std::error_code error;
  if (std::filesystem::is_directory(name, error))
    return "is a folder";
  std::ifstream in(name, std::ios::binary);
  if (!in)
    return "cannot be read";
  std::string text(header_size, '\0');
  in.read(text.data(), header_size);
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.compare(0, magic.size() + 1, magic + "\n") != 0)
    return "is not a checkpoint of billet";
  std::istringstream header(text.substr(magic.size() + 1));
  std::string word, program, sum;
  unsigned int format = 0;
  std::uintmax_t n_bytes = 0;
  header >> word >> format >> word >> program >> word >> n_bytes >> word >> sum;
  if (format != checkpoint_format)
    return "has format " + std::to_string(format) + ", but this program reads format " +
           std::to_string(checkpoint_format);
  if (program != version)
    return "was written by billet " + program + ", but this is billet " + version;
  const std::uintmax_t size = size_of(name);
  if (size != n_bytes)
    return "is truncated: it has " + std::to_string(size) + " of " + std::to_string(n_bytes) + " bytes";
  if (checksum(in) != sum)
    return "is damaged: its checksum does not match";
  return "";
}

} // namespace

CheckpointReader::CheckpointReader(MPI_Comm communicator, const std::string &file_name,
                                   const std::string &origin)
    : communicator_(communicator), file_name_(file_name), origin_(origin) {
  silence_hdf5();
  fail_together(communicator, [&] {
    std::string fault;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      fault = find_fault(file_name);
    if (!fault.empty() && !std::filesystem::exists(file_name))
      fault = "does not exist";
    if (!fault.empty())
      throw InputError(origin + ": '" + file_name + "' " + fault +
                       "; allowed is a complete checkpoint of this program");
  });
  fail_together(communicator, [&] {
    file_ = H5Fopen(file_name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file_ < 0)
      throw InputError(origin + ": '" + file_name +
                       "' cannot be opened on every rank; allowed is a file that all ranks can read");
  });
  load("", [&] { n_ranks_ = count("ranks"); });
}

CheckpointReader::~CheckpointReader() {
  if (file_ >= 0)
    H5Fclose(file_);
}

void CheckpointReader::load(const std::string &group, const std::function<void()> &load) {
  const std::string outside = group_;
  try {
    in(group, load);
  } catch (const InputError &error) {
    group_ = outside;
    throw InputError(origin_ + ": '" + file_name_ + "' does not match this scene: " + error.what());
  }
}

void CheckpointReader::enter(const std::string &name) { group_ += name + "/"; }

void CheckpointReader::leave() {
  group_.pop_back();
  group_.resize(group_.rfind('/') == std::string::npos ? 0 : group_.rfind('/') + 1);
}

bool CheckpointReader::has(const std::string &name) const {
  return H5Lexists(file_, (group_ + name).c_str(), H5P_DEFAULT) > 0;
}

namespace {

/// Returns the numbers of rows and columns of an array. An array that says to have more than the
/// file holds is refused: it would take the memory of the machine.
std::array<hsize_t, 2> extent_of(const hid_t set, const std::string &name) {
  const CheckpointHandle space(H5Dget_space(set), H5Sclose), type(H5Dget_type(set), H5Tclose);
  std::array<hsize_t, 2> size{};
  if (H5Sget_simple_extent_ndims(space.id()) != 2 ||
      H5Sget_simple_extent_dims(space.id(), size.data(), nullptr) != 2)
    throw InputError("its '" + name + "' is no table");
  const hsize_t n_bytes = H5Dget_storage_size(set), width = H5Tget_size(type.id());
  if (width == 0 || (size[0] > 0 && size[1] > n_bytes / width / size[0]))
    throw InputError("its '" + name + "' is incomplete");
  return size;
}

/// Opens an array. Throws InputError if there is none.
CheckpointHandle open_array(const hid_t file, const std::string &name) {
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (set < 0)
    throw InputError("it has no '" + name + "'");
  return {set, H5Dclose};
}

/// Returns all values of an array.
template <class T> std::vector<T> read_all(const hid_t file, const std::string &name, const hid_t type) {
  const CheckpointHandle set = open_array(file, name);
  const auto [n_rows, n_columns] = extent_of(set.id(), name);
  std::vector<T> values(n_rows * n_columns);
  if (!values.empty() && H5Dread(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw InputError("its '" + name + "' cannot be read");
  return values;
}

} // namespace

std::vector<double> CheckpointReader::read(const std::string &name) const {
  return read_all<double>(file_, group_ + name, H5T_NATIVE_DOUBLE);
}

std::string CheckpointReader::read_text(const std::string &name) const {
  const auto letters = read_all<char>(file_, group_ + name, H5T_NATIVE_CHAR);
  return {letters.begin(), letters.end()};
}

std::size_t CheckpointReader::n_rows(const std::string &name) const {
  const std::string path = group_ + name + "/keys";
  return extent_of(open_array(file_, path).id(), path)[0];
}

std::vector<double> CheckpointReader::read_rows(const std::string &name, const std::size_t width,
                                                const std::vector<std::uint64_t> &keys,
                                                std::vector<bool> *found) const {
  std::vector<double> result(width * keys.size(), 0.);
  std::vector<bool> is_there(keys.size(), false);
  fail_together(communicator_, [&] {
    const std::string path = group_ + name;
    const auto all_keys = read_all<std::uint64_t>(file_, path + "/keys", H5T_NATIVE_UINT64);
    const CheckpointHandle set = open_array(file_, path + "/rows"), space(H5Dget_space(set.id()), H5Sclose);
    const std::array<hsize_t, 2> size = extent_of(set.id(), path);
    if (size[0] != all_keys.size())
      throw InputError("its '" + path + "' has " + std::to_string(size[0]) + " rows for " +
                       std::to_string(all_keys.size()) + " nodes or elements");
    if (size[1] != width)
      throw InputError("its '" + path + "' has " + std::to_string(size[1]) +
                       " numbers in a row, expected are " + std::to_string(width));
    std::vector<std::pair<std::uint64_t, std::size_t>> wanted; // with their places
    for (std::size_t i = 0; i < keys.size(); ++i)
      wanted.emplace_back(keys[i], i);
    std::sort(wanted.begin(), wanted.end());
    // Read the file in blocks, and only those with wanted rows.
    const std::size_t n_part = std::max<std::size_t>(1, n_at_once / std::max<std::size_t>(1, width) / 4);
    std::vector<std::pair<std::size_t, std::size_t>> matches; // row, place
    std::vector<double> part;
    for (std::size_t begin = 0; begin < all_keys.size(); begin += n_part) {
      const std::size_t n = std::min(n_part, all_keys.size() - begin);
      matches.clear();
      for (std::size_t row = begin; row < begin + n; ++row)
        for (auto match = std::lower_bound(wanted.begin(), wanted.end(),
                                           std::make_pair(all_keys[row], std::size_t{0}));
             match != wanted.end() && match->first == all_keys[row]; ++match)
          matches.emplace_back(row - begin, match->second);
      if (matches.empty())
        continue;
      part.resize(n * width);
      const std::array<hsize_t, 2> start{begin, 0}, count{n, width};
      const CheckpointHandle memory(H5Screate_simple(2, count.data(), nullptr), H5Sclose);
      if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0 ||
          H5Dread(set.id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT, part.data()) < 0)
        throw InputError("its '" + path + "' cannot be read");
      for (const auto &[row, place] : matches) {
        std::copy_n(&part[row * width], width, &result[place * width]);
        is_there[place] = true;
      }
    }
    if (found == nullptr && std::count(is_there.begin(), is_there.end(), false) > 0)
      throw InputError("its '" + path + "' lacks " +
                       std::to_string(std::count(is_there.begin(), is_there.end(), false)) + " of " +
                       std::to_string(keys.size()) +
                       " nodes or elements: the boundaries of a contact pair may have changed");
  });
  if (found != nullptr)
    *found = is_there;
  return result;
}

// --- when ----------------------------------------------------------------------------------------

namespace {

/// Returns the number of whole intervals between checkpoints up to this time.
unsigned int count_intervals(const double time, const double interval) {
  return static_cast<unsigned int>(times::count_intervals(time, interval));
}

} // namespace

Checkpoints::Checkpoints(const parameters::Output &parameters, MPI_Comm communicator)
    : parameters_(parameters), communicator_(communicator) {}

bool Checkpoints::is_due(const unsigned int step, const double time) const {
  const auto &[every_steps, interval, keep] = parameters_.checkpoint;
  return (every_steps > 0 && step % every_steps == 0) ||
         (interval > 0. && count_intervals(time, interval) > n_intervals_);
}

std::string Checkpoints::write(const double time, const std::function<void(StateWriter &)> &save) {
  Usage::count(Capability::checkpoints, 1);
  const Checkpoints before(*this);
  std::ostringstream name;
  name << parameters_.folder.value << "/checkpoint_" << std::setw(5) << std::setfill('0') << n_written_
       << ".h5";
  // The saved state describes the schedule after this checkpoint.
  ++n_written_;
  if (parameters_.checkpoint.interval > 0.)
    n_intervals_ = count_intervals(time, parameters_.checkpoint.interval);
  files_.push_back(name.str());
  std::vector<std::string> too_many;
  while (files_.size() > parameters_.checkpoint.keep) {
    too_many.push_back(files_.front());
    files_.erase(files_.begin());
  }
  CheckpointWriter writer(communicator_, name.str());
  save(writer);
  std::string failure = writer.finish();
  if (!failure.empty()) {
    n_written_ = before.n_written_; // n_intervals_ stays: the next try is at the next interval
    files_ = before.files_;
  } else if (dealii::Utilities::MPI::this_mpi_process(communicator_) == 0) {
    std::error_code ignored;
    for (const auto &file : too_many)
      std::filesystem::remove(file, ignored);
  }
  return failure;
}

void Checkpoints::save(StateWriter &writer) const {
  std::string names;
  for (const auto &file : files_)
    names += std::filesystem::path(file).filename().string() + "\n";
  writer.write_text("checkpoints", names);
  writer.write("checkpoints written", {static_cast<double>(n_written_)});
}

void Checkpoints::load(const StateReader &reader, const double time, const bool is_same_folder) {
  if (parameters_.checkpoint.interval > 0.)
    n_intervals_ = count_intervals(time, parameters_.checkpoint.interval);
  if (!is_same_folder)
    return;
  n_written_ = reader.count("checkpoints written");
  // These files will be removed: a name that is none of this class's own could be any file of the
  // user.
  const std::regex own_name("checkpoint_[0-9]{5,10}\\.h5");
  std::istringstream names(reader.read_text("checkpoints"));
  for (std::string name; std::getline(names, name);) {
    if (!std::regex_match(name, own_name))
      throw InputError("it names '" + name +
                       "' as a checkpoint before it; allowed are names such as checkpoint_00001.h5");
    files_.push_back(parameters_.folder.value + "/" + name);
  }
}

// --- signals -------------------------------------------------------------------------------------

namespace {

constexpr std::array<int, 4> heeded{SIGTERM, SIGINT, SIGUSR1, SIGUSR2};
// Set by the signal handler.
volatile std::sig_atomic_t end_signal = 0, checkpoint_signal = 0;

extern "C" void note_signal(const int signal) {
  if (signal == SIGUSR2)
    checkpoint_signal = 1;
  else
    end_signal = signal;
}

std::string name_of(const int signal) {
  switch (signal) {
  case SIGTERM:
    return "SIGTERM";
  case SIGINT:
    return "SIGINT";
  default:
    return "SIGUSR1";
  }
}

} // namespace

Signals::Signals(MPI_Comm communicator, const double seconds_between_checks)
    : communicator_(communicator), seconds_between_checks_(seconds_between_checks),
      last_check_(std::chrono::steady_clock::now()) {
  end_signal = checkpoint_signal = 0;
  for (const int signal : heeded) {
    struct sigaction action {};
    action.sa_handler = note_signal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    if (signal == SIGTERM || signal == SIGINT)
      action.sa_flags |= static_cast<int>(SA_RESETHAND);
    sigaction(signal, &action, nullptr);
  }
}

Signals::~Signals() {
  for (const int signal : heeded)
    std::signal(signal, SIG_DFL);
}

Signals::Request Signals::poll() {
  if (seconds_between_checks_ > 0. && !is_time_to_check())
    return Request::none;
  std::array<int, 2> requests{end_signal, checkpoint_signal};
  checkpoint_signal = 0;
  MPI_Allreduce(MPI_IN_PLACE, requests.data(), 2, MPI_INT, MPI_MAX, communicator_);
  if (requests[0] == 0)
    return requests[1] == 0 ? Request::none : Request::checkpoint;
  name_ = name_of(requests[0]);
  return Request::end;
}

bool Signals::is_time_to_check() {
  if (++n_calls_ < next_check_)
    return false;
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - last_check_).count();
  last_check_ = now;
  const double wanted = n_calls_ * seconds_between_checks_ / std::max(seconds, 1e-9);
  next_check_ = static_cast<unsigned int>(std::clamp(wanted, 1., std::min(1e6, 10. * n_calls_)));
  next_check_ = dealii::Utilities::MPI::broadcast(communicator_, next_check_, 0);
  n_calls_ = 0;
  return true;
}

} // namespace billet
