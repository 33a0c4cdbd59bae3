// SPDX-License-Identifier: LGPL-2.1-or-later
// What a run paid for and did not need: each part alone, and none where it was needed or is small.
#include "billet/run/unneeded_costs.h"

#include "../testing.h"

using namespace billet;
using billet::testing::check;

namespace {

/// Returns the seconds of the note; 0: there is none.
double seconds(const RunCosts &costs) {
  const DiagnosticList list = find_unneeded_costs(costs);
  return list.empty() ? 0. : list.front().measure().value();
}

bool says(const RunCosts &costs, const std::string &what) {
  const DiagnosticList list = find_unneeded_costs(costs);
  return !list.empty() && list.front().text().find(what) != std::string::npos;
}

} // namespace

int main() {
  RunCosts costs;
  costs.all = 20.;
  check("nothing", seconds(costs), 0.);
  costs.unsymmetric_matrix = 10.;
  check("half of an unsymmetric matrix", std::abs(seconds(costs) - 5.), 1e-12);
  check("it is named", says(costs, "though nothing slides"));
  costs.slides = true;
  check("sliding needs it", seconds(costs), 0.);
  costs.self_contact = 4.;
  check("self-contact", std::abs(seconds(costs) - 4.), 1e-12);
  costs.self_contact_touches = true;
  check("that touches", seconds(costs), 0.);
  costs.fields = 3.;
  check("fields", std::abs(seconds(costs) - 3.) + (says(costs, "'Interval'") ? 0. : 1.), 1e-12);
  costs.fields = 1.9;
  check("few fields", seconds(costs), 0.);
  costs.target = 0.01;
  costs.error_control = 6.;
  costs.steps_error = 0.002;
  check("steps that the target requires", seconds(costs), 0.);
  costs.steps_error = 0.0005;
  check("finer ones", std::abs(seconds(costs) - 6.), 1e-12);
  costs.all = 0.9;
  costs.fields = 0.;
  costs.error_control = 0.8;
  check("a short run", seconds(costs), 0.);
  return testing::exit_code();
}
