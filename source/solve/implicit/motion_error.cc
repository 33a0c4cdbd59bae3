// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/motion_error.h"

#include <algorithm>
#include <cmath>

namespace billet {

MotionError::MotionError(const Scene &scene, const Discretization &discretization, const LocalNodes &nodes,
                         const Inertia &inertia, const Vector &lumped)
    : discretization_(discretization), parameters_(scene.parameters().implicit_dynamics), inertia_(inertia),
      lumped_(lumped), body_axes_(discretization.owned_dofs().n_elements()) {
  Vector positions = discretization.make_owned_vector();
  for (std::size_t b = 0; b < discretization.n_bodies(); ++b)
    for (const auto &element : nodes.elements(b))
      for (const unsigned int node : element)
        for (unsigned int i = 0; i < 3; ++i) {
          const DofIndex dof = nodes.dofs(node)[i];
          if (!discretization.owned_dofs().is_element(dof))
            continue;
          positions(dof) = get_vector(nodes.positions().data(), node)[i];
          body_axes_[discretization.owned_dofs().index_within_set(dof)] = {b, i};
        }
  positions.compress(dealii::VectorOperation::insert);
  for (const Spread &spread : spread_of_bodies(positions))
    if (spread.mass > 0.)
      max_gyration_ = std::max(max_gyration_, std::sqrt(spread.square / spread.mass));
  memory_.set(is_wanted() ? sizeof(max_displacement_) : 0);
}

double MotionError::wanted_accuracy() const {
  return is_wanted() ? std::min(1., parameters_.error_tolerance / Limits::default_tolerance) : 1.;
}

double MotionError::mean_size(const Vector &field) const {
  Vector ghosted = discretization_.make_ghosted_vector();
  ghosted = field;
  return std::sqrt(std::max(0., field * inertia_.times(ghosted)) / inertia_.total());
}

std::vector<MotionError::Spread> MotionError::spread_of_bodies(const Vector &field) const {
  constexpr std::size_t n_sums = 7; // of each body Σ m x and Σ m by axis, Σ m x²
  std::vector<double> sums(n_sums * discretization_.n_bodies());
  std::size_t k = 0;
  for (const DofIndex dof : discretization_.owned_dofs()) {
    const BodyAxis at = body_axes_[k++];
    double *sum = &sums[n_sums * at.body];
    const double x = field(dof), m = lumped_(dof);
    sum[at.axis] += m * x;
    sum[3 + at.axis] += m;
    sum[6] += m * x * x;
  }
  dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
  std::vector<Spread> spreads;
  for (std::size_t body = 0; body < discretization_.n_bodies(); ++body) {
    const double *sum = &sums[n_sums * body];
    double square = sum[6];
    for (unsigned int i = 0; i < 3; ++i)
      square -= sum[3 + i] > 0. ? sum[i] * sum[i] / sum[3 + i] : 0.;
    spreads.push_back({std::max(0., square), sum[3]});
  }
  return spreads;
}

double MotionError::displacement_to_resolve(const Vector &displacements) const {
  double own = 0.;
  for (const Spread &spread : spread_of_bodies(displacements))
    own += spread.square;
  return std::max({std::sqrt(own / inertia_.total()), std::min(mean_size(displacements), max_gyration_),
                   Limits::min_displacement * discretization_.radius()});
}

double MotionError::of_step(const double factor, const Vector &change, const Vector &displacements) const {
  Usage::count(Capability::error_control, 1);
  const double error = factor * mean_size(change);
  const double reference = parameters_.reference_displacement > 0.
                               ? parameters_.reference_displacement
                               : std::max(max_displacement_, displacement_to_resolve(displacements));
  return error / (parameters_.error_tolerance * reference);
}

void MotionError::commit(const Vector &displacements) {
  if (is_wanted() && parameters_.reference_displacement == 0.)
    max_displacement_ = std::max(max_displacement_, displacement_to_resolve(displacements));
}

} // namespace billet
