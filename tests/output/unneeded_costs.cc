// SPDX-License-Identifier: LGPL-2.1-or-later
// What a run paid for and did not need: each part alone, and none where it was needed, is small, or has no
// remedy.
#include "billet/run/unneeded_costs.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace unneeded_costs_test {

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

/// A block on a plane, with friction and what else is given.
bool helps(const std::string &material, const std::string &loads, const std::string &solver,
           const std::string &friction = "0.1") {
  const std::string file = "block.prm";
  std::ofstream(file)
      << "subsection Bodies\n  subsection block\n    subsection Mesh\n      set Primitive = hyper_rectangle\n"
         "      set Arguments = 0, 0, 0 : 1, 1, 1 : true\n    end\n    set Symmetry planes = x = 0 ; y = 0\n"
         "    subsection Material\n      set Young modulus = 1000\n"
      << material << "    end\n    subsection Loads\n      subsection load\n"
      << loads
      << "        set Boundary ids = 5\n      end\n    end\n  end\nend\n"
         "subsection Tools\n  subsection floor\n    subsection Surfaces\n      subsection plane\n      end\n"
         "    end\n  end\nend\nset Contact = all\nsubsection General contact\n"
         "  set Friction coefficient = "
      << friction << "\nend\nsubsection Solver\n"
      << solver << "end\n";
  return helps_symmetrised_contact(Scene(parameters::Scene::read(file)));
}

void check_remedies() {
  const std::string law = "set Elasticity = hypoelastic\nset Yield stress = 10\n";
  const std::string dead = "set Type = dead traction\nset Traction = 0, 0, -1\n";
  const std::string following = "set Type = pressure\nset Pressure = 1\n";
  check("symmetrised contact suffices", helps("", dead, ""));
  check("nothing to symmetrise without friction", !helps("", dead, "", "0"));
  check("a following pressure stays unsymmetric", !helps("", following, ""));
  check("a law stays unsymmetric if its tangent is exact",
        !helps(law, dead, "set Material tangent = exact\n"));
  check("a law follows the matrix by default", helps(law, dead, ""));
}

} // namespace

BILLET_MPI_TEST(unneeded_costs) {
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
  costs.limited_steps = 8.;
  check("finer ones of the scene's maximum", std::abs(seconds(costs) - 10.), 1e-12);
  costs.unsymmetric_matrix = 2.;
  costs.slides = false;
  check("parts of steps count once", std::abs(seconds(costs) - (1. + 6. + 0.5 * 7.)), 1e-12);
  costs.fields = 3.;
  check("fields are none", std::abs(seconds(costs) - (1. + 3. + 6. + 0.5 * 7.)), 1e-12);
  costs.fields = 0.;
  costs.slides = true;
  costs.steps_error = 0.002;
  check("a maximum that the target requires", seconds(costs), 0.);
  costs.all = 0.9;
  costs.fields = 0.;
  costs.error_control = 0.8;
  check("a short run", seconds(costs), 0.);
  check_remedies();
}

} // namespace unneeded_costs_test
