// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/free_mass.h"

#include <deal.II/lac/solver_cg.h>

#include <algorithm>
#include <functional>

namespace billet {

namespace {

/// Mass matrix on free dofs, x -> CᵀMC x, C the homogeneous constraints.
struct CondensedMass {
  const FreeMass &mass;
  const Supports &supports;

  void vmult(Vector &result, const Vector &x) const {
    Vector all = x;
    supports.homogeneous().distribute(all);
    result = mass.times(all);
    supports.condense(result);
  }
};

/// Divides by the row sums.
struct LumpedMass {
  const Vector &row_sums;

  void vmult(Vector &result, const Vector &x) const {
    result = x;
    std::transform(result.begin(), result.end(), row_sums.begin(), result.begin(), std::divides<>());
  }
};

Vector ones(const Discretization &discretization) {
  Vector result = discretization.make_owned_vector();
  result = 1.;
  return result;
}

} // namespace

FreeMass::FreeMass(const Scene &scene, const Discretization &discretization, const Supports &supports,
                   const bool is_lumped)
    : discretization_(discretization), supports_(supports), inertia_(scene, discretization, is_lumped),
      row_sums_(times(ones(discretization))) {}

Vector FreeMass::times(const Vector &x) const {
  Vector ghosted = discretization_.make_ghosted_vector();
  ghosted = x;
  return inertia_.times(ghosted);
}

Vector FreeMass::accelerations_by(const Vector &forces) const {
  Vector rhs = forces, result = discretization_.make_owned_vector();
  rhs *= -1.;
  supports_.condense(rhs);
  const double size = rhs.l2_norm();
  if (size == 0.)
    return result;
  // The mass over its row sums has eigenvalues from 1/27 to 1 in bricks: about thirty iterations.
  constexpr double relative_tolerance = 1e-12;
  constexpr unsigned int max_iterations = 1000;
  dealii::SolverControl control(max_iterations, relative_tolerance * size, false, false);
  dealii::SolverCG<Vector> solver(control);
  try {
    solver.solve(CondensedMass{*this, supports_}, result, rhs, LumpedMass{row_sums_});
  } catch (const dealii::SolverControl::NoConvergence &) {
    // Round-off in bodies of very different densities prevents convergence; the error is of that
    // size.
  }
  supports_.homogeneous().distribute(result);
  return result;
}

} // namespace billet
