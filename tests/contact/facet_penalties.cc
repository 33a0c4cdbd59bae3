// SPDX-License-Identifier: LGPL-2.1-or-later
// Penalties of contact between surfaces: what springs and multipliers carry before and after an augmentation,
// what a stiffer penalty keeps, errors relative to a tolerance, and how far penalties may still rise.
#include "billet/contact/facet_contact.h"
#include "billet/friction/coulomb.h"

#include "surfaces.h"

#include <deal.II/base/mpi.h>

namespace facet_penalties_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

constexpr ContactStiffness penalty{1e3, 5e2};
constexpr double depth = 0.01, slip = 1e-3, size = 0.1, tolerance = 0.05, coefficient = 0.3,
                 round_off = 1e-12;

/// A square sheet of area 1 on a larger one, which sticks to it after a push along x.
class Pressed {
public:
  explicit Pressed(const FacetMethod method, const double tolerance_of_pair = tolerance)
      : surface_(make_sheets()), part_(surface_, [](const std::size_t) { return true; }),
        before_(part_.take(surface_.positions)), after_(before_),
        contact_(MPI_COMM_SELF, make_settings(method, tolerance_of_pair), part_.node_keys, part_.facets,
                 std::vector<ContactStiffness>(part_.nodes.size(), penalty),
                 std::vector<double>(part_.nodes.size(), size)) {
    for (unsigned int node = 0; node < 8 * 6; ++node)
      after_[node][0] += slip;
    Positions ignored(before_.size());
    contact_.add_forces(before_, before_, 0., ignored);
    contact_.commit();
    contact_.restart();
    force();
  }

  /// Evaluates the push again, with the upper sheet raised by `up`. Returns the force on it.
  Tensor<1, 3> force(const double up = 0.) {
    Positions positions = after_, forces(after_.size());
    for (unsigned int node = 0; node < 8 * 6; ++node)
      positions[node][2] += up;
    contact_.add_forces(before_, positions, 1., forces);
    return contact_.works().compute_load().force;
  }
  FacetContact &contact() { return contact_; }
  FacetPenalties &penalties() { return contact_.penalties(); }

private:
  static Surface make_sheets() {
    Surface surface;
    add_sheet(surface, 7, 5, 0, 0.05, [](const double s, const double t) {
      return Tensor<1, 3>({t, s, -depth}); // looks down
    });
    add_sheet(surface, 11, 13, 1, 0.05, [](const double s, const double t) {
      return Tensor<1, 3>({2. * s - 0.5, 2. * t - 0.5, 0.});
    });
    return surface;
  }
  static FacetContactSettings make_settings(const FacetMethod method, const double tolerance_of_pair) {
    FacetContactSettings settings;
    settings.method = method;
    settings.friction = make_coulomb(coefficient);
    settings.two_pass = false;
    settings.search_margin = 0.05;
    settings.penetration_tolerance = tolerance_of_pair;
    settings.max_stiffening = {8., 6.};
    return settings;
  }

  Surface surface_;
  Part part_;
  Positions before_, after_;
  FacetContact contact_;
};

double error(const Tensor<1, 3> &force, const double pressure, const double friction) {
  return (force - Tensor<1, 3>({-friction, 0., pressure})).norm() / pressure;
}

void check_augmentation(const FacetMethod method, const std::string &name) {
  Pressed sheets(method);
  FacetPenalties &penalties = sheets.penalties();
  const double pressure = penalty.normal * depth, friction = penalty.tangential * slip;
  const Tensor<1, 3> first = sheets.force();
  check(name + "springs push", error(first, pressure, friction), round_off);
  ContactSprings springs = penalties.compute_springs();
  check(name + "  and carry all of it", near(springs.normal.force, pressure, round_off) &&
                                            near(springs.normal.held, pressure, round_off) &&
                                            near(springs.tangential.force, friction, round_off) &&
                                            near(springs.tangential.held, friction, round_off));
  check(name + "  at each node", springs.normal.of_nodes.size() == 48 &&
                                     springs.normal.of_nodes.size() == springs.tangential.of_nodes.size());
  check(name + "the error is that of the gap",
        near(penalties.augmentation_error(), depth / size / tolerance, round_off));

  penalties.augment();
  check(name + "multipliers add to springs", error(sheets.force(), 2. * pressure, 2. * friction), round_off);
  springs = penalties.compute_springs();
  check(name + "  which carry as much as before",
        near(springs.normal.force, 2. * pressure, round_off) &&
            near(springs.normal.held, pressure, round_off) &&
            near(springs.tangential.force, 2. * friction, round_off) &&
            near(springs.tangential.held, friction, round_off));
  check(name + "without a gap, multipliers push alone",
        error(sheets.force(depth - 1e-9), pressure, 2. * friction), 1e-5);
  check(name + "  and the error is that of the slip",
        near(penalties.augmentation_error(), slip / size / tolerance, round_off));

  penalties.scale(4., 2.);
  check(name + "stiffer springs keep multipliers",
        error(sheets.force(0.75 * depth), 2. * pressure, 3. * friction), 1e-10);
  check(name + "  and are known", penalties.stiffening() == 4. && penalties.tangential_stiffening() == 2.);
  check(name + "  as is how much stiffer they may be",
        penalties.stiffening_left() == 2. && penalties.tangential_stiffening_left() == 3.);
  check(name + "  and the stiffest",
        near(penalties.max_spring(), 4. * penalty.normal * size * size, round_off));
  penalties.scale(0.25, 0.5);
  penalties.take_back_augmentation();
  check(name + "an augmentation is taken back", (sheets.force() - first).norm() / first.norm(), 1e-14);
  penalties.augment();
  sheets.contact().restart();
  check(name + "  by a restart, too", (sheets.force() - first).norm() / first.norm(), 1e-14);
}

void check_stiffening_under_load(const FacetMethod method, const std::string &name) {
  Pressed sheets(method, 0.);
  FacetPenalties &penalties = sheets.penalties();
  check(name + "no tolerance, no error", penalties.augmentation_error() == 0.);
  const Tensor<1, 3> before = sheets.force();
  penalties.scale_under_load(4., 1.);
  check(name + "less penetration at once",
        near(sheets.contact().measures().penetration().length, 0.25 * depth, round_off));
  check(name + "  and the same force", (sheets.force() - before).norm() / before.norm(), round_off);
  check(name + "  of less penetration",
        near(sheets.contact().measures().penetration().length, 0.25 * depth, round_off));
  check(name + "  by stiffer springs",
        error(sheets.force(-depth), 5. * penalty.normal * depth, penalty.tangential * slip), round_off);
}

} // namespace

BILLET_MPI_TEST(facet_penalties) {
  for (const auto &[method, name] : {std::pair<FacetMethod, std::string>{FacetMethod::planed, "planed: "},
                                     {FacetMethod::overlap, "overlap: "}}) {
    check_augmentation(method, name);
    check_stiffening_under_load(method, name);
  }
}

} // namespace facet_penalties_test
