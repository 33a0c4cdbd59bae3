// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/spent_time.h"

#include <pthread.h>

namespace billet {

std::array<double, static_cast<std::size_t>(Work::n)> SpentTime::seconds{};

namespace {
auto start = std::chrono::steady_clock::now();
/// A process that another one forks counts from there.
const int is_registered = pthread_atfork(nullptr, nullptr, [] { start = std::chrono::steady_clock::now(); });
} // namespace

double SpentTime::on_all() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace billet
