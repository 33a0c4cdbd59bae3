// SPDX-License-Identifier: LGPL-2.1-or-later
// Penalties that are soft are told by either sign, again where nodes are much deeper, and not where depths
// are no matter.
#include "billet/solve/penalty_watch.h"
#include "../testing.h"
#include "billet/diagnostic_kinds.h"

#include <cmath>

using billet::PenaltyWatch;
using billet::testing::check;

namespace {

using Message = std::optional<billet::Diagnostic>;

bool tells(const Message &message, const std::string &what) {
  return message && message->kind().key == std::string("penalty-too-low") &&
         message->text().find(what) != std::string::npos;
}

/// In facets of size 2.
Message look(PenaltyWatch &watch, const double of_facet, const double displacement) {
  return watch.look("pair", {of_facet, 2. * of_facet}, displacement);
}

} // namespace

int main() {
  {
    PenaltyWatch watch(PenaltyWatch::Motion::slow);
    check("a hundredth of a facet after a motion of one is no matter", !look(watch, 0.01, 2.));
    check("a tenth is, nearly", !look(watch, 0.099, 2.) && !watch.has_soft_pairs());
    const Message text = look(watch, 0.11, 4.);
    check("more is told", tells(text, "Nodes penetrate by 0.11 facet sizes (pair 'pair'") &&
                              tells(text, "'Normal penalty', or"));
    check("once", !look(watch, 1., 40.) && watch.has_soft_pairs());
    check("and again at ten times that", tells(look(watch, 1.2, 40.), "1.2 facet sizes"));
    check("of each pair", watch.look("other", {0.2, 0.4}, 40.).has_value());
  }
  {
    PenaltyWatch watch(PenaltyWatch::Motion::slow);
    const Message text = look(watch, 1e-3, 4e-3);
    check("half of the motion is told, however small",
          tells(text, "facet sizes, 50 % of the largest displacement"));
  }
  {
    // A flat body moves aside by much more than it is high.
    PenaltyWatch watch(PenaltyWatch::Motion::slow), sudden(PenaltyWatch::Motion::sudden);
    const auto look_at = [](PenaltyWatch &at, const double part_of_work) {
      return at.look("pair", {1e-3, 2e-3}, 1., part_of_work);
    };
    check("a tenth of the work is no matter", !look_at(watch, 0.1) && !watch.has_soft_pairs());
    check("half of it is told", tells(look_at(watch, 0.5), "the contact holds 50 % of the work done so far"));
    check("in a blow it is not", !look_at(sudden, 0.5) && !sudden.has_soft_pairs());
  }
  {
    PenaltyWatch watch(PenaltyWatch::Motion::slow);
    look(watch, 0., 1.);
    check("the largest motion so far counts", !look(watch, 0.01, 0.));
  }
  {
    PenaltyWatch watch(PenaltyWatch::Motion::sudden);
    check("a first touch is no matter", !look(watch, 1e-2, 2e-2));
    check("one that is deeper is not told, but noticed",
          !watch.has_soft_pairs() && !look(watch, 0.05, 0.1) && watch.has_soft_pairs());
    check("what gives way on is told", tells(look(watch, 0.2, 0.4), "100 % of the largest displacement"));
  }
  {
    billet::Placement from, to;
    to.translation[0] = 3.;
    check("a translation", billet::largest_motion(from, to, 10.) == 3.);
    to.rotation[0][0] = to.rotation[1][1] = std::cos(1e-3);
    to.rotation[0][1] = -(to.rotation[1][0] = std::sin(1e-3));
    const double motion = billet::largest_motion(from, to, 10.);
    check("and a turn, which moves no point farther than that", motion > 3.01 && motion < 3.02);
  }
  return billet::testing::exit_code();
}
