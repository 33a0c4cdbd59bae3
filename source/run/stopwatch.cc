// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/stopwatch.h"

#include <ctime>

namespace billet {

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

} // namespace billet
