// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_ITERATIVE_SOLVER_H
#define BILLET_ALGEBRA_ITERATIVE_SOLVER_H

#include "billet/algebra/direct_solver.h"

#include <functional>
#include <memory>
#include <vector>

namespace billet {

/// Input of an iterative solver beside the matrix. The dofs of a node are numbered in succession.
struct NodalGeometry {
  /// Position of the node of each owned dof along the dof's direction [length].
  std::vector<double> positions;
  /// Whether the row of each owned dof, by local number, is empty but for its diagonal.
  std::vector<bool> constrained;
};

/// Conjugate gradients, or GMRES with right preconditioning, with smoothed aggregation by ML. The
/// null space consists of the six rigid-body modes of the nodes in their present positions. Vaněk,
/// Mandel & Brezina, Computing 56 (1996) 179–196.
///
/// Stiff contact between bodies slows aggregation down. Therefore the contact dofs, Γ, are solved
/// for directly after each cycle,
///   z = B r,   z ← z + R_Γᵀ A_ΓΓ⁻¹ R_Γ (r − A z),                                              (1)
/// where B is a multigrid cycle for K + θ C instead of A = K + C. The factor θ makes the contact
/// stiffness C as soft as the bodies. If the first residual vanishes on Γ, all later ones do, and
/// (1) is symmetric on them. The convergence then depends on the Schur complements of both matrices
/// on the other dofs: their relative condition number is bounded for any penalty.
///
/// A hierarchy is kept for later matrices while it converges well. It does so while the logarithm
/// of the residual falls per iteration by at least `min_pace` of the initial rate. A_ΓΓ and the
/// residuals on the finest level always belong to the present matrix. A solve that fails with an
/// old hierarchy is repeated with a new one.
class IterativeSolver final : public LinearSolver {
public:
  struct Settings {
    IterativeMethod method = IterativeMethod::gmres;
    unsigned int max_iterations = 200;
    // Options that doc/results/linear-solvers.md compares.
    bool solve_contact = true; ///< apply (1); else a cycle alone
    /// Mean diagonal of θ C over that of K at the same dofs; 0: θ = 1.
    double contact_stiffness = 3.;
    /// Convergence of a kept hierarchy over that of a fresh one; > 1: none is kept.
    double min_pace = 0.6;
  };

  IterativeSolver(const Settings &settings, const Matrix &matrix, MPI_Comm communicator);
  ~IterativeSolver() override;

  /// Releases all data of the present matrix. Call it before the matrix is destroyed or gets
  /// another pattern, then set_matrix() with the next one.
  void release();
  void set_matrix(const Matrix &matrix) { matrix_ = &matrix; }

  /// Sets the geometry. Call it before factorize() whenever nodes have moved much.
  void set_geometry(NodalGeometry geometry);

  /// Starts the contact stiffness C of the next matrix: stores the rows of `dofs`, the owned dofs,
  /// by local number, of all nodes in contact. Call it when the matrix holds everything except the
  /// stiffness of contacts between bodies. The rows are kept until factorize(). Without this call
  /// the next matrix has no contact. Collective, like all members.
  void start_contact(const std::vector<int> &dofs);

  bool factorize() override;
  bool solve(const Vector &b, Vector &x, double relative_tolerance) override;
  std::string name() const override;
  unsigned int take_iterations() override;
  double memory() const override;
  /// Returns the number of hierarchies set up so far.
  unsigned int n_hierarchies() const { return n_hierarchies_; }

private:
  class Multigrid;
  class ContactBlock;

  /// Sets up a new hierarchy for the present matrix.
  bool renew();
  bool iterate(const Vector &rhs, Vector &solution, double relative_tolerance, unsigned int max_iterations);

  Settings settings_;
  const Matrix *matrix_;
  MPI_Comm communicator_;
  NodalGeometry geometry_;
  std::unique_ptr<Multigrid> multigrid_;
  std::unique_ptr<ContactBlock> started_; ///< of the next matrix
  std::unique_ptr<ContactBlock> contact_;
  bool is_lagging_ = false; ///< the hierarchy is that of an earlier matrix
  /// −ln of the residual reduction per iteration; 0: unknown.
  double fresh_pace_ = 0., last_pace_ = 0.;
  unsigned int iterations_ = 0, n_hierarchies_ = 0;
  double relative_residual_ = 0.; ///< |b − A x| / |b| of the last solve
};

} // namespace billet

#endif
