// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/spent_time.h"

namespace billet {

std::array<double, static_cast<std::size_t>(Work::n)> SpentTime::seconds{};

namespace {
const auto start = std::chrono::steady_clock::now();
}

double SpentTime::on_all() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace billet
