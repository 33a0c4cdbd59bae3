// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/nearest_name.h"

#include "../testing.h"

namespace nearest_name_test {

using billet::did_you_mean;
using billet::nearest_name;
using billet::testing::check;

// Names that a scene file misspells.

BILLET_TEST(nearest_name) {
  const std::vector<std::string> known = {
      "End time",     "Initial step",         "Young's modulus", "Poisson ratio",
      "Yield stress", "Friction coefficient", "Scheme",          "E"};
  check("a missing letter", nearest_name("Yield stres", known) == "Yield stress");
  check("an added letter", nearest_name("Endd time", known) == "End time");
  check("another letter", nearest_name("Scheze", known) == "Scheme");
  check("two letters exchanged", nearest_name("End tiem", known) == "End time");
  check("case", nearest_name("end TIME", known) == "End time");
  check("several letters", nearest_name("Poissons ratio", known) == "Poisson ratio");
  check("a beginning", nearest_name("Friction", known) == "Friction coefficient");
  check("a beginning before what is similar",
        nearest_name("implicit", {"explicit", "implicit dynamics"}) == "implicit dynamics");
  check("the same name but for case", nearest_name("voce", {"Voce", "Voce hardening"}) == "Voce");
  check("the nearest of two", nearest_name("Mas", {"Max", "Mass", "Mast"}) == "Max");
  check("two beginnings are none", nearest_name("Penalty", {"Penalty factor", "Penalty growth"}).empty());
  check("a stranger is none", nearest_name("Temperature", known).empty());
  check("half of the letters are too many", nearest_name("Band lime", {"End timer"}).empty());
  check("one letter is no name", nearest_name("F", known).empty());
  check("no name", nearest_name("", known).empty());
  check("none is known", nearest_name("End time", {}).empty());
  check("in a message", did_you_mean("Endtime", known) == "; did you mean 'End time'?");
  check("no advice", did_you_mean("Temperature", known).empty());
}

} // namespace nearest_name_test
