// SPDX-License-Identifier: LGPL-2.1-or-later
// Limits of a refinement during the run: energies that finer elements may change, and the time over which
// forces fade that do not balance on them.
#include "billet/errors.h"
#include "billet/run/resumption.h"
#include "billet/solve/restart.h"

#include "../testing.h"

namespace mesh_change_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;

namespace {

/// Whether a refinement is refused that changes the energies by these parts of all: those of contact springs,
/// and all of them.
bool is_refused(const double of_contact, const double of_all) {
  constexpr double energy = 40.;
  MeshChange change{{}, {true}, 0.5, "body 'block'", {}};
  change.before.elastic = 0.75 * energy;
  change.before.contact = 0.25 * energy;
  EnergyLedger after = change.before;
  after.contact += of_contact * energy;
  try {
    change.check("scene.prm", of_all * energy, after);
  } catch (const SolutionFailure &) {
    return true;
  }
  return false;
}

/// Returns the time over which forces fade in a scene of length 8.
double release_time(const double given) {
  parameters::Scene scene{};
  scene.time_stepping.end_time = 8.;
  scene.restart.release_time = given;
  return refinement_release_time(scene);
}

} // namespace

BILLET_TEST(mesh_change) {
  check("contact springs may gain little of all energy, and lose it",
        is_refused(0.5, 0.) && !is_refused(1e-4, 0.) && !is_refused(-0.5, 0.));
  check("the energy may not change by more than there was",
        is_refused(0., 3.) && !is_refused(0., 0.1) && is_refused(0., -3.) && !is_refused(0., -0.1));
  check("unbalanced forces fade over a tenth of the run", near(release_time(0.), 0.8, 1e-12));
  check("unless the scene gives a time", release_time(0.3) == 0.3);
}

} // namespace mesh_change_test
