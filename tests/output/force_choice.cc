// SPDX-License-Identifier: LGPL-2.1-or-later
// The console shows the largest loads of a run, whatever their order; a couple by its moment.
#include "billet/output/force_choice.h"
#include "../testing.h"

#include <string>

namespace force_choice_test {

using billet::ForceChoice;
using billet::testing::check;

namespace {

/// Returns what is shown, such as "0 3M".
std::string text(const ForceChoice &choice) {
  std::string text;
  for (const auto &shown : choice.shown())
    text += (text.empty() ? "" : " ") + std::to_string(shown.load) + (shown.is_moment ? "M" : "");
  return text;
}

} // namespace

BILLET_TEST(force_choice) {
  {
    ForceChoice choice(2, 5, 10.);
    check("all loads that there is room for", text(choice) == "0 1");
    check("then those with forces", choice.update({{0., 0.}, {7., 70.}}) && text(choice) == "1");
    check("and what comes later", choice.update({{1., 0.}, {7., 70.}}) && text(choice) == "0 1");
  }
  {
    ForceChoice choice(4, 2, 10.);
    check("at the start the first ones", text(choice) == "0 1");
    check("without loads they stay", !choice.update({{}, {}, {}, {}}) && text(choice) == "0 1");
    check("the largest, in the order of the scene",
          choice.update({{1., 0.}, {}, {3., 0.}, {2., 0.}}) && text(choice) == "2 3");
    check("what was large stays", !choice.update({{1., 0.}, {}, {}, {}}) && text(choice) == "2 3");
    check("a little larger is no reason for a change",
          !choice.update({{2.9, 0.}, {}, {}, {}}) && text(choice) == "2 3");
    check("half as large again is", choice.update({{3.1, 0.}, {}, {}, {}}) && text(choice) == "0 2");
  }
  {
    ForceChoice choice(3, 2, 10.);
    check("round-off takes no place, nor does what has no force",
          choice.update({{100., 0.}, {}, {1e-5, 0.}}) && text(choice) == "0");
    check("a small force does", choice.update({{}, {}, {1e-3, 0.}}) && text(choice) == "0 2");
  }
  {
    ForceChoice choice(1, 5, 10.);
    check("a couple is shown by its moment", choice.update({{1e-8, 50.}}) && text(choice) == "0M");
    check("until it has a force", choice.update({{0.1, 50.}}) && text(choice) == "0");
  }
  {
    ForceChoice choice(2, 1, 10.);
    check("a moment counts by the size of the model",
          choice.update({{1., 0.}, {0., 20.}}) && text(choice) == "1M");
  }
}

} // namespace force_choice_test
