// SPDX-License-Identifier: LGPL-2.1-or-later
// A message reports round-off of contact where it takes a part of the maximum forces of a run, not of a light
// first step.
#include "billet/solve/round_off_watch.h"
#include "billet/diagnostic_kinds.h"

#include "../testing.h"

#include <cmath>

namespace round_off_watch_test {

using billet::RoundOffWatch;
using billet::testing::check;

namespace {

bool contains(const billet::DiagnosticList &messages, const billet::DiagnosticKind &kind,
              const std::string &what) {
  return messages.size() == 1 && &messages.front().kind() == &kind &&
         messages.front().what().find(what) != std::string::npos;
}

} // namespace

BILLET_TEST(round_off_watch) {
  using namespace billet::diagnostic;
  constexpr double tolerance = 5e-3;
  check("nothing without a step", RoundOffWatch().finish(tolerance, false).empty());
  RoundOffWatch watch;
  watch.add(0.1, 1e-6, 1e-8);
  check("a run that ends with the first touch",
        contains(watch.finish(tolerance, false), round_off_limits_forces,
                 "may be 1e+02 of the maximum forces"));
  watch.add(0.2, 1e-6, 1.);
  check("a light first touch is no matter", watch.finish(tolerance, false).empty());
  watch.add(0.3, 1e-6, 1e-8);
  check("nor a light end", watch.finish(tolerance, false).empty());
  RoundOffWatch later;
  later.load(watch.save());
  later.add(0.4, 0.01, 1.);
  check("the message has its time",
        contains(later.finish(tolerance, false), round_off_limits_forces, "accepted") &&
            later.finish(tolerance, false).front().time().value() == 0.4);
  later.add(0.5, 0.5, 1.);
  check("more is a doubt in statics",
        contains(later.finish(tolerance, false), round_off_limits_forces, "to this part only"));
  check("but not in dynamics", contains(later.finish(tolerance, true), round_off_limits_forces, "accepted"));
  RoundOffWatch fine;
  fine.add(1., 1e-9, 1.);
  check("below 1e-8 it is a note", contains(fine.finish(1e-10, false), balanced_to_round_off, "balance"));
}

} // namespace round_off_watch_test
