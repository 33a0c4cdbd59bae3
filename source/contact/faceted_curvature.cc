// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/faceted_curvature.h"

#include "billet/algebra/gather.h"
#include "billet/contact/surface_correction.h"
#include "billet/diagnostic_kinds.h"
#include "billet/discretization/smooth_facets.h"
#include "billet/errors.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/box_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

struct FacetedCurvatureLimits {
  /// Chord gap, and error of the surface correction, over the largest displacement, above which a
  /// run warns: about the error of an engineering result. A motion much larger than the gap closes
  /// it in any case.
  static constexpr double notable = 0.03;
};

/// Search for the facets near a point.
class NearFacets {
public:
  explicit NearFacets(const std::vector<SmoothFacet> &facets) : facets_(facets), tree_(make_boxes(facets)) {}

  struct Found {
    const SmoothFacet *facet = nullptr;
    FacetProjection projection;
  };
  /// Finds the nearest facet that faces this normal, at most at the distance `reach`.
  Found find(const Tensor<1, 3> &x, const Tensor<1, 3> &normal, const double reach) const {
    constexpr double cosine_of_facing = -0.5;
    Found found;
    double square = reach * reach;
    tree_.visit_near(x, square, [&](const unsigned int f) {
      const SmoothFacet &facet = facets_[f];
      if (!(facet.normal * normal < cosine_of_facing))
        return;
      const FacetProjection projection = BilinearFacet(facet.corners).project(x, {});
      if (projection.exists && projection.gap * projection.gap < square) {
        square = projection.gap * projection.gap;
        found = {&facet, projection};
      }
    });
    return found;
  }

private:
  static std::vector<BoundingBox> make_boxes(const std::vector<SmoothFacet> &facets) {
    std::vector<BoundingBox> boxes;
    boxes.reserve(facets.size());
    for (const auto &facet : facets) {
      boxes.push_back(BoundingBox::empty());
      for (const auto &corner : facet.corners)
        boxes.back().add(corner);
    }
    return boxes;
  }

  const std::vector<SmoothFacet> &facets_;
  BoxTree tree_;
};

bool fit(const SmoothFacet &facet, const SmoothFacet &other) {
  constexpr double difference = 0.25;
  return facet.curvature * other.curvature < 0. &&
         std::abs(facet.curvature + other.curvature) <=
             difference * std::max(std::abs(facet.curvature), std::abs(other.curvature));
}

/// Angle that a facet turns, below which it is flat.
constexpr double min_turn = 1e-6;
/// Part of the clearance above which a chord gap counts.
constexpr double part_of_clearance = 0.2;

} // namespace

ChordGap find_chord_gap(const Discretization &discretization, const BodyPair &pair,
                        const Vector *displacements) {
  const MPI_Comm communicator = discretization.communicator();
  std::size_t n_own_facets = 0, n_others = 0;
  const auto facets = collect_smooth_facets(discretization, pair.bodies[0], pair.boundary_ids[0],
                                            displacements, n_own_facets),
             others = collect_smooth_facets(discretization, pair.bodies[1], pair.boundary_ids[1],
                                            displacements, n_others);
  const NearFacets near(others);
  constexpr std::array<double, 3> along{-1., 0., 1.};
  std::array<double, 6> worst{}; // relative, gap, clearance, position
  bool fits = false;
  for (std::size_t f = 0; f < n_own_facets; ++f) {
    const SmoothFacet &facet = facets[f];
    if (!(std::abs(facet.curvature) * facet.size > min_turn))
      continue;
    for (const double xi : along)
      for (const double eta : along) {
        const Tensor<1, 3> x = facet::interpolate(facet::weights({xi, eta}), facet.corners);
        const auto found = near.find(x, facet.normal, facet.size);
        if (found.facet == nullptr || !fit(facet, *found.facet))
          continue;
        fits = true;
        const double error = facet::height<double>(facet.bulge, {xi, eta}) +
                             facet::height(found.facet->bulge, found.projection.parameters),
                     clearance = found.projection.gap - error, relative = std::abs(error) / facet.size;
        if (relative > worst[0] && std::abs(error) > part_of_clearance * std::abs(clearance))
          worst = {relative, std::abs(error), clearance, x[0], x[1], x[2]};
      }
  }
  ChordGap result;
  for (const auto &of_rank : all_gather(communicator, worst))
    if (of_rank[0] > result.relative)
      result = {of_rank[1], of_rank[0], of_rank[2], Tensor<1, 3>({of_rank[3], of_rank[4], of_rank[5]})};
  result.fits = dealii::Utilities::MPI::max(fits ? 1 : 0, communicator) > 0;
  return result;
}

namespace {

using Correction = parameters::ContactPair::Correction;

/// Whether a pair consists of two bodies without surface correction.
bool is_faceted(const BodyPair &pair) {
  return pair.correction.kind == Correction::Kind::none && !pair.is_self_contact &&
         pair.bodies[0] != pair.bodies[1];
}

Diagnostic describe(const BodyPair &pair, const ChordGap &chords, const std::string &when) {
  std::ostringstream text;
  text << "The curved faces fit each other, but the chords of their facets differ " << when << "by up to "
       << chords.gap << " (" << chords.relative << " facet sizes); the clearance of the true surfaces is "
       << chords.clearance;
  return Diagnostic(diagnostic::faceted_curvature, text.str())
      .pair(pair.name)
      .at(chords.position)
      .value("chord gap [length]", chords.gap)
      .value("clearance [length]", chords.clearance)
      .measure("chord gap [facet sizes]", chords.relative);
}

} // namespace

DiagnosticList find_faceted_curvature(const Scene &scene, const Discretization &discretization) {
  DiagnosticList diagnostics;
  for (const auto &pair : scene.body_pairs()) {
    if (!is_faceted(pair))
      continue;
    const ChordGap chords = find_chord_gap(discretization, pair);
    if (chords.relative > pair.input->initial.allowed_penetration.value)
      diagnostics.push_back(describe(pair, chords, ""));
  }
  return diagnostics;
}

DiagnosticList find_faceted_curvature(const Scene &scene, const Discretization &discretization,
                                      const Vector &displacements, const double time) {
  const double notable = FacetedCurvatureLimits::notable * displacements.linfty_norm();
  DiagnosticList diagnostics;
  for (const auto &pair : scene.body_pairs()) {
    if (pair.correction.kind != Correction::Kind::none) {
      const double error = find_correction_error(discretization, pair);
      if (!(error > notable))
        continue;
      std::ostringstream text;
      text.precision(3);
      text << "'Surface correction' leaves errors of up to " << error
           << " in the gap, since facets are large beside the radius";
      diagnostics.push_back(Diagnostic(diagnostic::faceted_curvature, text.str())
                                .pair(pair.name)
                                .measure("error of the gap [length]", error)
                                .advice("Use smaller facets on both faces"));
      continue;
    }
    if (!is_faceted(pair))
      continue;
    const ChordGap at_start = find_chord_gap(discretization, pair);
    const double allowed = pair.input->initial.allowed_penetration.value;
    if (!at_start.fits || at_start.relative > allowed)
      continue;
    const ChordGap chords = find_chord_gap(discretization, pair, &displacements);
    if (chords.relative > allowed || chords.gap > notable)
      diagnostics.push_back(describe(pair, chords, "at the end ").time(time));
  }
  return diagnostics;
}

} // namespace billet
