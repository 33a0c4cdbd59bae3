// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_FUZZ_H
#define BILLET_TESTS_FUZZ_H

#include "../checks.h"
#include "damage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

/// A fuzz target defines corpus() and judge(), and ends with BILLET_FUZZ_TARGET. It is
/// - a test, which damages each file of the corpus some hundred times, the same on every machine;
/// - with arguments N [SEED], a program that does so N times and prints how many are refused and the longest
/// time;
/// - with the argument --corpus FOLDER, one that writes the corpus, for other fuzzers;
/// - with BILLET_FUZZ (the option BILLET_FUZZERS of CMake), a program of clang's libFuzzer, or of afl++.
namespace billet::testing {

enum class Outcome {
  refused,  ///< with a message
  accepted, ///< and what was read fits the redundancy of the format
  unsound   ///< accepted, although counts, indices, sizes or checksums do not fit; or a message that is none
};

/// Returns sound files by their names.
std::map<std::string, std::string> corpus();
/// Reads a file.
Outcome judge(const std::string &bytes);

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

/// Damages a file of the corpus n times.
inline void fuzz(const std::string &name, const std::string &sound, const unsigned int n, Damage &damage,
                 const bool prints) {
  std::map<Outcome, unsigned int> n_of;
  double longest = 0.;
  for (unsigned int i = 0; i < n; ++i) {
    const std::string bytes = damage(sound);
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = judge(bytes);
    longest =
        std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    ++n_of[outcome];
    if (outcome == Outcome::unsound) // kept, to be looked at
      write_bytes("unsound_" + std::to_string(i) + "_" + name, bytes);
  }
  if (prints)
    std::cout << name << ": " << n << " files, " << n_of[Outcome::refused] << " refused, longest " << longest
              << " s" << std::endl;
  check(name + " sound", judge(sound) == Outcome::accepted);
  check(name + " damaged", n_of[Outcome::unsound] == 0 && n_of[Outcome::refused] > 0);
}

inline int fuzz_main(const int argc, char **argv) {
  if (argc > 2 && std::string(argv[1]) == "--corpus") {
    std::filesystem::create_directories(argv[2]);
    for (const auto &[name, bytes] : corpus())
      write_bytes(std::string(argv[2]) + "/" + name, bytes);
    return 0;
  }
  const unsigned int n = argc > 1 ? static_cast<unsigned int>(std::stoul(argv[1])) : 400;
  Damage damage(argc > 2 ? static_cast<unsigned int>(std::stoul(argv[2])) : 1);
  for (const auto &[name, bytes] : corpus())
    fuzz(name, bytes, n, damage, argc > 1);
  return exit_code();
}

} // namespace billet::testing

#ifdef BILLET_FUZZ
#define BILLET_FUZZ_TARGET                                                                                   \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *const data, const std::size_t size) {            \
    const std::string bytes(reinterpret_cast<const char *>(data), size);                                     \
    if (billet::testing::judge(bytes) == billet::testing::Outcome::unsound)                                  \
      __builtin_trap();                                                                                      \
    return 0;                                                                                                \
  }
#else
#define BILLET_FUZZ_TARGET                                                                                   \
  int main(int argc, char **argv) { return billet::testing::fuzz_main(argc, argv); }
#endif

#endif
