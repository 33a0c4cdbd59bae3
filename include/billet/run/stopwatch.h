// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_STOPWATCH_H
#define BILLET_RUN_STOPWATCH_H

#include <chrono>

namespace billet {

/// Returns the CPU time of this process [s].
double processor_time();

/// Sums wall-clock and CPU time of parts of a run [s].
class Stopwatch {
public:
  template <class Part> void measure(const Part &part) {
    const auto start = std::chrono::steady_clock::now();
    const double processor_start = processor_time();
    part();
    processor_seconds_ += processor_time() - processor_start;
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  double seconds() const { return seconds_; }
  double processor_seconds() const { return processor_seconds_; }

private:
  double seconds_ = 0., processor_seconds_ = 0.;
};

} // namespace billet

#endif
