// SPDX-License-Identifier: LGPL-2.1-or-later
// A time integrator that is registered from outside the library: scenes name it, set its parameter, and are
// refused those of others.
#include "billet/errors.h"
#include "billet/integration/time_integrator_type.h"
#include "billet/parameters/scene.h"

#include "../testing.h"

#include <fstream>
#include <sstream>

using namespace billet;
using billet::testing::check;

namespace {

/// Wood, Bossak & Zienkiewicz (1981): the weights of inertia alone.
TimeIntegratorType bossak_type() {
  return {"Bossak",
          "Wood, Bossak & Zienkiewicz (1981)",
          {{"Inertia weight", "-0.1", TypeParameter::Kind::number, "From -1/3 to 0."}},
          [](const TypeInput &input) {
            const double alpha = input.number("Inertia weight");
            if (!(alpha >= -1. / 3. && alpha <= 0.))
              input.reject("Inertia weight", "a number from -1/3 to 0");
            return TimeIntegrator(alpha, 0., 0.25 * (1. - alpha) * (1. - alpha), 0.5 - alpha);
          }};
}

/// The scene of tests/cli with these lines in place of its method.
parameters::Scene read_with(const std::string &lines) {
  std::ifstream file(std::string(SOURCE_DIR) + "/../cli/drop.prm");
  std::ostringstream all;
  all << file.rdbuf();
  std::string text = all.str();
  const std::size_t first = text.find("  set Method "), end = text.find("end", first);
  text.replace(first, end - first, lines);
  std::ofstream("scene.prm") << text;
  return parameters::Scene::read("scene.prm");
}

std::string refusal(const std::string &lines) {
  try {
    read_with(lines);
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

} // namespace

int main() {
  time_integrator_types().add(bossak_type());
  const TimeIntegrator integrator =
      read_with("  set Method = Bossak\n  set Inertia weight = -0.2\n").implicit_dynamics.integrator;
  check("weights of the one that the scene names",
        integrator.alpha_m() == -0.2 && integrator.alpha_f() == 0. && integrator.gamma() == 0.7);
  check("its default", read_with("  set Method = Bossak\n").implicit_dynamics.integrator.alpha_m() == -0.1);
  check("its range", refusal("  set Method = Bossak\n  set Inertia weight = 1\n").find("from -1/3 to 0") !=
                         std::string::npos);
  check("parameters of others",
        refusal("  set Method = Bossak\n  set Alpha = -0.1\n").find("'Method = Bossak' does not use it") !=
            std::string::npos);
  bool is_refused = false;
  try {
    time_integrator_types().add(bossak_type());
  } catch (const std::logic_error &) {
    is_refused = true;
  }
  check("a name that is taken", is_refused);
  return billet::testing::exit_code();
}
