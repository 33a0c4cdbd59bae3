// SPDX-License-Identifier: LGPL-2.1-or-later
// Penalties that are too low are reported by either sign, and not where penetrations are small.
#include "billet/solve/penalty_watch.h"
#include "../testing.h"

#include <cmath>

namespace penalty_watch_test {

using billet::PenaltyWatch;
using billet::testing::check;

namespace {

bool contains(const std::string &text, const std::string &what) {
  return text.find(what) != std::string::npos;
}

std::string text_of(const billet::DiagnosticList &messages) {
  return messages.empty() ? "" : messages.front().text();
}

/// In facets of size 2.
std::string inspect(PenaltyWatch &watch, const double of_facet, const double displacement) {
  return text_of(watch.check("pair", 0.5, {of_facet, 2. * of_facet}, displacement));
}

} // namespace

BILLET_TEST(penalty_watch) {
  {
    PenaltyWatch watch(PenaltyWatch::Motion::slow);
    check("a hundredth of a facet after a motion of one is no matter", inspect(watch, 0.01, 2.).empty());
    check("a tenth is, nearly", inspect(watch, 0.099, 2.).empty() && !watch.has_low_penalties());
    const std::string text = inspect(watch, 0.11, 4.);
    check("a warning is printed above a tenth",
          contains(
              text,
              "Nodes penetrate by 0.11 facet sizes (pair 'pair', time 0.5). Increase 'Normal penalty', or"));
    check("of each pair", !watch.check("other", 0.6, {0.2, 0.4}, 40.).empty() && watch.has_low_penalties());
  }
  {
    PenaltyWatch watch(PenaltyWatch::Motion::slow);
    const std::string text = inspect(watch, 1e-3, 4e-3);
    check("and at half of the motion, however small",
          contains(text, "sizes, 50 % of the maximum displacement"));
  }
  {
    // A flat body moves aside by much more than it is high.
    PenaltyWatch watch(PenaltyWatch::Motion::slow), sudden(PenaltyWatch::Motion::sudden);
    const auto inspect_at = [](PenaltyWatch &at, const double part_of_work) {
      return text_of(at.check("pair", 0.5, {1e-3, 2e-3}, 1., part_of_work));
    };
    check("a tenth of the work is no matter", inspect_at(watch, 0.1).empty() && !watch.has_low_penalties());
    check("a warning is printed at half of it",
          contains(inspect_at(watch, 0.5), "the penalty stores 50 % of the work done so far"));
    check("in a blow it is not", inspect_at(sudden, 0.5).empty() && !sudden.has_low_penalties());
  }
  {
    PenaltyWatch watch(PenaltyWatch::Motion::slow);
    inspect(watch, 0., 1.);
    check("the largest motion so far counts", inspect(watch, 0.01, 0.).empty());
  }
  {
    PenaltyWatch watch(PenaltyWatch::Motion::sudden);
    check("a first touch is no matter", inspect(watch, 1e-2, 2e-2).empty());
    check("a deeper one gives no warning, but is noticed",
          !watch.has_low_penalties() && inspect(watch, 0.05, 0.1).empty() && watch.has_low_penalties());
    check("a deep node is no matter for a moment", inspect(watch, 0.2, 0.4).empty());
    check("a warning is printed if it stays deep",
          contains(inspect(watch, 0.2, 0.4), "100 % of the maximum displacement"));
    check("and what takes energy at once", !watch.check("other", 0.5, {0.2, 0.4}, 4., 0.02).empty());
  }
  {
    // Depths [facet sizes], displacements and parts of the work, each just beside a limit.
    const auto warns = [](const PenaltyWatch::Motion motion, const double of_facet, const double of_motion,
                          const double of_work) {
      PenaltyWatch watch(motion);
      return !watch.check("pair", 0.5, {of_facet, 1.}, 1. / of_motion, of_work).empty();
    };
    constexpr auto slow = PenaltyWatch::Motion::slow, sudden = PenaltyWatch::Motion::sudden;
    check("a tenth of a facet is deep", warns(slow, 0.102, 0.01, 0.) && !warns(slow, 0.098, 0.01, 0.));
    check("a fifth of the motion is much", warns(slow, 0.01, 0.21, 0.) && !warns(slow, 0.01, 0.19, 0.));
    check("and of the work", warns(slow, 0.01, 0.01, 0.21) && !warns(slow, 0.01, 0.01, 0.19));
    check("unless penetration is below 1e-6 of a facet",
          warns(slow, 1.1e-6, 0.5, 0.5) && !warns(slow, 0.9e-6, 0.5, 0.5));
    const auto is_noticed = [](const double of_facet) {
      PenaltyWatch watch(PenaltyWatch::Motion::sudden);
      watch.check("pair", 0.5, {of_facet, 1.}, 2.);
      return watch.has_low_penalties();
    };
    check("or below a fiftieth in an impact", is_noticed(0.0205) && !is_noticed(0.0195));
    check("a hundredth of the work matters at once in an impact",
          warns(sudden, 0.2, 0.1, 0.0105) && !warns(sudden, 0.2, 0.1, 0.0095));
  }
  {
    billet::Placement from, to;
    to.translation[0] = 3.;
    check("a translation", billet::max_motion(from, to, 10.) == 3.);
    to.rotation[0][0] = to.rotation[1][1] = std::cos(1e-3);
    to.rotation[0][1] = -(to.rotation[1][0] = std::sin(1e-3));
    const double motion = billet::max_motion(from, to, 10.);
    check("and a turn, which moves no point farther than that", motion > 3.01 && motion < 3.02);
  }
}

} // namespace penalty_watch_test
