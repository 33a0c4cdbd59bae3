// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/tool_fade.h"

#include <algorithm>
#include <cmath>

namespace billet {

double left_after_removal(const Tool &tool, const double t) {
  if (!(tool.release_time() > 0.) || !std::isfinite(tool.removal_time()))
    return 0.;
  return std::clamp(1. - (t - tool.removal_time()) / tool.release_time(), 0., 1.);
}

} // namespace billet
