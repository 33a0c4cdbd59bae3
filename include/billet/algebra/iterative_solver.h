// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_ITERATIVE_SOLVER_H
#define BILLET_ALGEBRA_ITERATIVE_SOLVER_H

#include "billet/algebra/direct_solver.h"

#include <functional>
#include <memory>
#include <vector>

namespace billet {

/// What an iterative solver has to know beside the matrix. The dofs of a node are numbered in succession.
struct NodalGeometry {
  /// Of the node of each owned dof, its own component [length].
  std::vector<double> positions;
  /// Owned dofs, by their local number, whose row is empty but for its diagonal.
  std::vector<bool> constrained;
};

/// Conjugate gradients, or GMRES preconditioned from the right, with smoothed aggregation by ML: the six
/// rigid motions of the nodes as they stand are its null space, so that each aggregate has its own. Vaněk,
/// Mandel & Brezina, Computing 56 (1996) 179–196.
///
/// Stiff contact between bodies makes aggregation slow, the more the stiffer. Therefore the contact dofs, Γ,
/// are solved for directly after each cycle,
///   z = B r,   z ← z + R_Γᵀ A_ΓΓ⁻¹ R_Γ (r − A z),                                                      (1)
/// where B is a multigrid cycle not of A = K + C but of K + θ C, in which the contact stiffness C is as soft
/// as the bodies. With a first residual that vanishes on Γ all later ones do, (1) is symmetric on them, and
/// what has to be small is the condition of the Schur complements on the other dofs of both matrices against
/// each other: it is bounded whatever the penalty.
///
/// The hierarchy of an earlier matrix is kept as long as residuals fall with it, for each iteration, by
/// `least_pace` of the logarithm that they fell by when it was new; A_ΓΓ and the finest level's residuals are
/// always of the matrix itself. A solve that fails with an old hierarchy is repeated with a new one.
class IterativeSolver final : public LinearSolver {
public:
  enum class Method { conjugate_gradients, gmres };

  struct Settings {
    Method method = Method::gmres;
    unsigned int most_iterations = 200;
    // What doc/results/linear-solvers.md compares.
    bool solve_contact = true;     ///< (1); else a cycle alone
    double contact_stiffness = 3.; ///< of θ C, on average, over that of K at the same dofs; 0: θ = 1
    double least_pace = 0.6;       ///< of a kept hierarchy, part of a fresh one's; > 1: none is kept
  };

  IterativeSolver(const Settings &settings, const Matrix &matrix, MPI_Comm communicator);
  ~IterativeSolver() override;

  /// Forgets all that belongs to a matrix. To be called before the matrix goes, or gets another pattern;
  /// after that, the next one.
  void release();
  void set_matrix(const Matrix &matrix) { matrix_ = &matrix; }

  /// To be called before factorize() whenever nodes have moved much.
  void set_geometry(NodalGeometry geometry);

  /// To be called whenever the matrix holds all but the stiffness of contacts between bodies, before that is
  /// added: the owned dofs, by local number, of all nodes that touch. Their rows are kept until factorize(),
  /// to tell C from K. Collective, like all members. Without it the next matrix has no contact.
  void start_contact(const std::vector<int> &dofs);

  bool factorize() override;
  bool solve(const Vector &b, Vector &x, double relative_tolerance) override;
  std::string name() const override;
  unsigned int take_iterations() override;
  double memory() const override;
  /// |b − A x| / |b| of the last solve, computed anew.
  double relative_residual() const { return relative_residual_; }
  /// Hierarchies set up so far.
  unsigned int n_hierarchies() const { return n_hierarchies_; }

private:
  class Multigrid;
  class ContactBlock;

  /// A new hierarchy, of the matrix as it is.
  bool renew();
  bool iterate(const Vector &rhs, Vector &solution, double relative_tolerance, unsigned int most_iterations);

  Settings settings_;
  const Matrix *matrix_;
  MPI_Comm communicator_;
  NodalGeometry geometry_;
  std::unique_ptr<Multigrid> multigrid_;
  std::unique_ptr<ContactBlock> started_; ///< of the next matrix
  std::unique_ptr<ContactBlock> contact_;
  bool is_lagging_ = false;                 ///< the hierarchy is that of an earlier matrix
  double fresh_pace_ = 0., last_pace_ = 0.; ///< −ln of what an iteration leaves; 0: not known
  unsigned int iterations_ = 0, n_hierarchies_ = 0;
  double relative_residual_ = 0.;
};

} // namespace billet

#endif
