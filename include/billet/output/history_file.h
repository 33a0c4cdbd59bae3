// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_HISTORY_FILE_H
#define BILLET_OUTPUT_HISTORY_FILE_H

#include "billet/output/history_quantity.h"

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace billet {

/// History file history.csv: a line for every accepted step or, in explicit scenes, for every
/// interval of the history. Each line is flushed to disk. Written by the first rank.
class HistoryFile {
public:
  HistoryFile(const Scene &scene, const std::string &folder);

  /// Position in a history, to resume from.
  struct Mark {
    std::string columns; ///< its first line
    std::uintmax_t n_bytes = 0;
  };
  Mark mark();
  /// Continues after the mark of a run in the same folder. If the file has other columns, or is
  /// shorter, it is renamed with the `time` at which it ends, and a new one begins.
  HistoryFile(const Scene &scene, const std::string &folder, const Mark &mark, double time);

  /// `probes`: values of probe_columns().
  void write(const StepReport &report, const Solution &solution, const std::vector<double> &probes = {});
  /// Writes a line of an explicit scene: number of steps, and length of the next.
  void write(unsigned int step, double length, const Solution &solution,
             const std::vector<double> &probes = {});

private:
  void begin(const Scene &scene);
  void write(const HistorySample &sample);

  std::string name_;
  std::vector<HistoryQuantity> quantities_; ///< those that the scene has
  std::string columns_;
  WholeSection whole_;
  std::ofstream stream_;
};

} // namespace billet

#endif
