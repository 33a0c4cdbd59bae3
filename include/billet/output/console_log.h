// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_CONSOLE_LOG_H
#define BILLET_OUTPUT_CONSOLE_LOG_H

#include <iosfwd>
#include <memory>
#include <string>

namespace billet {

/// Copies all that the program prints on std::cout and std::cerr into a file, line by line, without
/// progress bars. What is printed before open() follows when the file is there. First rank only.
class ConsoleLog {
public:
  ConsoleLog();
  /// Restores the streams.
  ~ConsoleLog();
  ConsoleLog(const ConsoleLog &) = delete;
  ConsoleLog &operator=(const ConsoleLog &) = delete;

  /// Opens the file, and locks it until the program ends: two runs must not write into one folder.
  /// Appends if `continues`. Throws InputError if the file cannot be written or another run holds
  /// it.
  void open(const std::string &file_name, bool continues);
  /// Returns a stream into the file alone.
  std::ostream &file();

private:
  class Copy;
  class Entry;
  class Sink;

  std::unique_ptr<Sink> sink_;
  std::unique_ptr<Copy> output_, errors_;
  std::unique_ptr<Entry> entry_;
};

/// Whether a run that has not ended yet holds this log file.
bool is_held_by_a_run(const std::string &file_name);

} // namespace billet

#endif
