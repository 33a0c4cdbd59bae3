// SPDX-License-Identifier: LGPL-2.1-or-later
// Vectors in scenes: what separates their components, and what does not.
#include "billet/vector_text.h"

#include "../checks.h"

namespace vectors_test {

using namespace billet;
using testing::check;

namespace {

bool has(const std::string &text, const std::vector<std::string> &components) {
  return split_vector(text) == components;
}

} // namespace

BILLET_TEST(vectors) {
  check("semicolons", has("0 ; 0.5*t ;-2e3", {"0", "0.5*t", "-2e3"}));
  check("commas", has("0,0,-2000", {"0", "0", "-2000"}));
  check("commas and blanks", has(" 0 , 0 , -0.5*t ", {"0", "0", "-0.5*t"}));
  check("arguments of functions",
        has("atan2(y, x), if(t < 1, min(x, (y)), 0), 2", {"atan2(y, x)", "if(t < 1, min(x, (y)), 0)", "2"}));
  check("arguments between semicolons", has("atan2(y, x) ; 0 ; 1", {"atan2(y, x)", "0", "1"}));
  check("semicolons first: decimal commas stay", has("0,5 ; 0 ; 1,5*t", {"0,5", "0", "1,5*t"}));
  check("a decimal comma alone", has("0,5*t", {"0,5*t"}));
  check("two with a blank", has("0, 5*t", {"0", "5*t"}));
  check("two names", has("x,y", {"x", "y"}));
  check("an open bracket", has("max(0, 1, 2", {"max(0, 1, 2"}));
  check("a separator at the end", has("0 ; 0 ; 1 ;", {"0", "0", "1"}) && has("0, 0, 1,", {"0", "0", "1"}));
  check("a gap", has("0, , 1", {"0", "", "1"}) && has_empty_component(split_vector("0 ; ; 1")) &&
                     !has_empty_component(split_vector("0, 0, 1")));
  check("nothing", has("", {}) && has("  ", {}));
}

} // namespace vectors_test
