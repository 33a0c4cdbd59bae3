// SPDX-License-Identifier: LGPL-2.1-or-later
// Strains of a sheet, (B17), against closed forms: stretched, sheared in its plane and across it, turned in
// space; the normal of a brick; the forming limit curve.
#include "billet/mechanics/sheet_strains.h"

#include "billet/material/forming_limit.h"

#include "../material/texts.h"
#include "../testing.h"
#include "elements.h"

#include <cmath>

namespace sheet_strains_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

Tensor<2, 3> diagonal(const double x, const double y, const double z) {
  Tensor<2, 3> F;
  F[0][0] = x;
  F[1][1] = y;
  F[2][2] = z;
  return F;
}

/// Returns the largest error.
double compare(const Tensor<2, 3> &F, const Tensor<1, 3> &normal, const double major, const double minor,
               const double thinning) {
  const SheetStrains found = compute_sheet_strains(F, normal);
  return std::max(
      {std::abs(found.major - major), std::abs(found.minor - minor), std::abs(found.thinning - thinning)});
}

void check_strains() {
  const Tensor<1, 3> z({0., 0., 1.});
  check("no deformation", compare(unit, z, 0., 0., 0.), 1e-15);
  check("stretched in its plane", compare(diagonal(1.1, 1.4, 0.7), z, std::log(1.4), std::log(1.1), 0.3),
        1e-14);
  check("the other way round", compare(diagonal(1.4, 0.9, 0.8), z, std::log(1.4), std::log(0.9), 0.2), 1e-14);
  check("in another plane",
        compare(diagonal(0.7, 1.1, 1.4), Tensor<1, 3>({1., 0., 0.}), std::log(1.4), std::log(1.1), 0.3),
        1e-14);
  // Simple shear γ has the principal stretches ±asinh(γ/2).
  Tensor<2, 3> shear = unit, across = unit;
  shear[0][1] = 0.8;
  check("sheared in its plane", compare(shear, z, std::asinh(0.4), -std::asinh(0.4), 0.), 1e-14);
  across[0][2] = 0.8;
  check("sheared across it, its surfaces keep their distance", compare(across, z, 0., 0., 0.), 1e-14);
  Random random;
  Tensor<2, 3> R = random.tensor(1.);
  R = (unit - 0.5 * (R - dealii::transpose(R))) * dealii::invert(unit + 0.5 * (R - dealii::transpose(R)));
  check("and turned in space",
        compare(R * shear * diagonal(1.2, 1.2, 0.6), z, std::log(1.2) + std::asinh(0.4),
                std::log(1.2) - std::asinh(0.4), 0.4),
        1e-14);
  check("before it is stretched",
        compare(diagonal(1.1, 1.4, 0.7) * R, dealii::transpose(R) * z, std::log(1.4), std::log(1.1), 0.3),
        1e-14);
  check("nothing of a collapsed one", compare(diagonal(1., 1., 0.), z, 0., 0., 0.), 0.);
}

void check_normal() {
  for (unsigned int thin = 0; thin < 3; ++thin) {
    ElementVectors positions{};
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        positions[3 * a + i] = (a >> i & 1U) != 0 ? (i == thin ? 0.2 : 1. + i) : 0.;
    check("normal along axis " + std::to_string(thin),
          std::abs(std::abs(find_sheet_normal(positions)[thin]) - 1.), 1e-15);
  }
}

void check_limit() {
  const auto limit = FormingLimit::read(Texts("Forming limit", "-0.2 : 0.5, 0 : 0.3, 0.3 : 0.45"));
  WorstError error;
  for (const auto &[minor, major] :
       std::vector<std::array<double, 2>>{{-1., 0.5}, {-0.1, 0.4}, {0., 0.3}, {0.1, 0.35}, {2., 0.45}})
    error.add(std::abs(limit->major_strain(minor) - major));
  check("forming limit curve", error.value(), 1e-15);
  check("no curve", FormingLimit::read(Texts("Table", "")) == nullptr);
  for (const char *text : {"0", "0 : 0", "0 : 0.3, 0 : 0.4"}) {
    bool is_refused = false;
    try {
      FormingLimit::read(Texts("Forming limit", text));
    } catch (const std::invalid_argument &) {
      is_refused = true;
    }
    check(std::string("refuses '") + text + "'", is_refused);
  }
}

} // namespace

BILLET_TEST(sheet_strains) {
  check_strains();
  check_normal();
  check_limit();
}

} // namespace sheet_strains_test
