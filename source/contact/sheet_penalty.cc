// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/sheet_penalty.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <limits>

namespace billet {

namespace {

// Maximum of a sheet's volume over the area that may touch, as part of the extent of that area. The
// quotient is a half or all of its thickness.
constexpr double thickness_of_sheets = 0.02;

/// Whether the body of these facets is thin beside their extent. Collective.
bool is_thin(const Discretization &discretization, const std::size_t body,
             const std::vector<BoundaryFacet> &facets) {
  std::vector<double> sums(2, 0.), ends(6, -std::numeric_limits<double>::infinity());
  for (const auto &element : discretization.elements(body))
    sums[0] += element.cell->measure();
  for (const auto &facet : facets) {
    sums[1] += facet.area_vector().norm();
    for (const auto &x : facet.corners)
      for (unsigned int i = 0; i < 3; ++i) {
        ends[i] = std::max(ends[i], x[i]);
        ends[3 + i] = std::max(ends[3 + i], -x[i]);
      }
  }
  dealii::Utilities::MPI::sum(sums, discretization.communicator(), sums);
  dealii::Utilities::MPI::max(ends, discretization.communicator(), ends);
  const double extent = std::hypot(ends[0] + ends[3], ends[1] + ends[4], ends[2] + ends[5]);
  return sums[0] < thickness_of_sheets * extent * sums[1];
}

} // namespace

bool may_have_sheet_penalty(const ContactPair &pair, const Discretization &discretization,
                            const std::vector<BoundaryFacet> &facets) {
  return pair.limits_softness() && !pair.input->penalty.is_given &&
         is_thin(discretization, pair.body, facets);
}

} // namespace billet
