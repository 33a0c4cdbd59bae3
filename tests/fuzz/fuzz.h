// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_FUZZ_H
#define BILLET_TESTS_FUZZ_H

#include "../checks.h"
#include "damage.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

/// A fuzz target defines corpus(), sound files by their names, and judge(), which reads a file, and ends with
/// BILLET_FUZZ_TARGET(NAME). It is
/// - a test, which damages each file of the corpus 400 times, the same on every machine, or n times with
/// BILLET_FUZZ_TARGET_OF(NAME, n);
/// - with arguments N [SEED] behind its name, one that does so N times and prints how many are refused and
/// the maximum time; doc/results/damaged-files.md has these of all targets;
/// - with the argument --corpus FOLDER, one that writes the corpus, for other fuzzers;
/// - with BILLET_FUZZ (the option BILLET_FUZZERS of CMake), a program of clang's libFuzzer, or of afl++.
namespace billet::testing {

enum class Outcome {
  refused,  ///< with a message
  accepted, ///< and what was read fits the redundancy of the format
  unsound   ///< accepted, although counts, indices, sizes or checksums do not fit; or a message that is none
};

/// Whether a message can be printed: no byte of it is a command of a terminal.
inline bool is_message(const std::string &text) {
  return !text.empty() && std::none_of(text.begin(), text.end(), [](const char c) {
    return (static_cast<unsigned char>(c) < ' ' && c != '\n') || c == '\x7F';
  });
}

inline std::string bytes_of(const std::string &file_name) {
  std::ostringstream bytes;
  bytes << std::ifstream(file_name, std::ios::binary).rdbuf();
  return bytes.str();
}

inline void write_bytes(const std::string &file_name, const std::string &bytes) {
  std::ofstream(file_name, std::ios::binary) << bytes;
}

/// Maximum processor time for a file [s], of this process and of those that it starts.
constexpr double max_seconds = 10.;

/// Returns the processor time of this process and of its children that have ended [s].
inline double processor_time() {
  double seconds = 0.;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval &time : {usage.ru_utime, usage.ru_stime})
      seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return seconds;
}

/// Ends the program while a file is read that hangs it. The system calls it.
inline void report_hang(int /*signal*/) {
  const char text[] = "A file is read without end: FAILED\n";
  const auto written = write(STDOUT_FILENO, text, sizeof text - 1);
  _exit(written < 0 ? 3 : 2);
}

/// Damages a file n times, and judges what is made of it. The damage is a function from bytes to bytes.
template <class Function, class Judge>
void fuzz(const std::string &name, const std::string &sound, const unsigned int n, Function &damage,
          const bool prints, const Judge &judge_file) {
  constexpr unsigned int max_wall_seconds = 600; // the machine may be busy
  std::signal(SIGALRM, report_hang);
  std::map<Outcome, unsigned int> n_of;
  double longest = 0.;
  const auto keep = [&](const char *const why, const unsigned int i, const std::string &bytes) {
    write_bytes(std::string(why) + "_" + std::to_string(i) + "_" + name, bytes);
  };
  for (unsigned int i = 0; i < n; ++i) {
    const std::string bytes = damage(sound);
    const double start = processor_time();
    alarm(max_wall_seconds);
    const Outcome outcome = judge_file(bytes);
    alarm(0);
    const double seconds = processor_time() - start;
    longest = std::max(longest, seconds);
    ++n_of[outcome];
    if (outcome == Outcome::unsound) // kept, to be looked at
      keep("unsound", i, bytes);
    if (seconds > max_seconds)
      keep("slow", i, bytes);
  }
  if (prints)
    std::cout << name << ": " << n << " files, " << n_of[Outcome::refused] << " refused, "
              << n_of[Outcome::unsound] << " unsound, longest " << longest << " s" << std::endl;
  check(name + " sound", judge_file(sound) == Outcome::accepted);
  check(name + " damaged", n_of[Outcome::unsound] == 0 && n_of[Outcome::refused] > 0);
  check(name + " within " + std::to_string(std::lround(max_seconds)) + " s", longest <= max_seconds);
}

/// The test of a target.
template <class Judge>
void fuzz_files(const std::map<std::string, std::string> &corpus, const Judge &judge_file,
                const unsigned int usual_n) {
  const std::vector<std::string> &given = arguments();
  if (given.size() == 2 && given[0] == "--corpus") {
    std::filesystem::create_directories(given[1]);
    for (const auto &[name, bytes] : corpus)
      write_bytes(given[1] + "/" + name, bytes);
    return;
  }
  const unsigned int n = given.empty() ? usual_n : static_cast<unsigned int>(std::stoul(given[0]));
  Damage damage(given.size() < 2 ? 1 : static_cast<unsigned int>(std::stoul(given[1])));
  for (const auto &[name, bytes] : corpus)
    fuzz(name, bytes, n, damage, !given.empty(), judge_file);
}

} // namespace billet::testing

#ifdef BILLET_FUZZ
#define BILLET_FUZZ_TARGET_OF(name, n)                                                                       \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *const data, const std::size_t size) {            \
    const std::string bytes(reinterpret_cast<const char *>(data), size);                                     \
    if (judge(bytes) == billet::testing::Outcome::unsound)                                                   \
      __builtin_trap();                                                                                      \
    return 0;                                                                                                \
  }
#else
#define BILLET_FUZZ_TARGET_OF(name, n)                                                                       \
  BILLET_TEST(name) { billet::testing::fuzz_files(corpus(), judge, n); }
#endif
#define BILLET_FUZZ_TARGET(name) BILLET_FUZZ_TARGET_OF(name, 400)

#endif
