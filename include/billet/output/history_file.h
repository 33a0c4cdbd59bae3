// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_HISTORY_FILE_H
#define BILLET_OUTPUT_HISTORY_FILE_H

#include "billet/output/history_quantity.h"

#include <fstream>
#include <string>
#include <vector>

namespace billet {

/// history.csv: a line for every accepted step, or of an explicit scene as often as it asks, on disk as soon
/// as it is known. Written by the first rank.
class HistoryFile {
public:
  HistoryFile(const Scene &scene, const std::string &folder);

  /// How far a history has come.
  struct Mark {
    std::string columns; ///< its first line
    double n_bytes = 0.;
  };
  Mark mark();
  /// Goes on behind the mark of a run in the same folder. If the file has other columns, or is shorter, it is
  /// kept under another name that tells the `time` until which it goes, and a new one is begun.
  HistoryFile(const Scene &scene, const std::string &folder, const Mark &mark, double time);

  void write(const StepReport &report, const SolutionState &state);
  /// Of an explicit scene: steps taken, and the length of the next.
  void write(unsigned int step, double length, const SolutionState &state);

private:
  void begin(const Scene &scene);
  void write(const HistorySample &sample);

  std::string name_;
  std::vector<HistoryQuantity> quantities_; ///< those that the scene has
  std::string columns_;
  std::ofstream stream_;
};

} // namespace billet

#endif
