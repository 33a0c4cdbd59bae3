// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_TANGENT_SOLVER_H
#define BILLET_SOLVE_TANGENT_SOLVER_H

#include "billet/algebra/iterative_solver.h"
#include "billet/diagnostics.h"
#include "billet/parameters/control.h"
#include "billet/usage.h"

#include <memory>
#include <string>
#include <vector>

namespace billet {

/// The linear solver of a scene: a direct one, or an iterative one whose place a direct one takes for every
/// matrix with which it stagnates.
class TangentSolver {
public:
  /// `automatic` is resolved here. `matrix` must outlive the solver.
  TangentSolver(const parameters::Solver &settings, bool symmetric, const Matrix &matrix,
                MPI_Comm communicator);

  /// To be called before the matrix goes, or gets another pattern; ...
  void release();
  /// ... after that, the next one.
  void set_matrix(const Matrix &matrix);

  /// Whether the next matrices are nearly singular: a direct solver, if there is an iterative one, does
  /// those.
  void expect_nearly_singular(const bool is) { is_nearly_singular_ = is; }
  bool is_iterative() const { return iterative_ != nullptr; }
  /// Only of use where it is iterative; see IterativeSolver.
  void set_geometry(NodalGeometry geometry);
  void start_contact(const std::vector<int> &dofs);

  /// Prepares solves with the matrix as it is now. False, as from solve(), on all ranks.
  bool factorize();
  /// |b − A x| <= relative_tolerance |b|
  bool solve(const Vector &b, Vector &x, double relative_tolerance);

  const std::string &name() const { return name_; }
  const std::string &failure() const { return failure_; }
  /// Of an iterative solver, since the last call.
  unsigned int take_iterations();
  /// Messages since the last call: how much memory an iterative solver takes, that a direct one had to help.
  DiagnosticList take_diagnostics();
  /// That the matrix factorised last is ill-conditioned; once.
  DiagnosticList check_condition();

private:
  bool factorize_directly();
  bool fall_back();
  /// Of the matrix just factorised, by two solves.
  void estimate_condition();
  /// |A| |x|/|b|: no more than the condition of the matrix, and for free.
  void watch_condition(const Vector &b, const Vector &x);

  DirectMethod direct_method_;
  bool symmetric_;
  const Matrix *matrix_;
  MPI_Comm communicator_;
  std::unique_ptr<IterativeSolver> iterative_;
  std::unique_ptr<LinearSolver> direct_;
  bool is_direct_now_;
  bool is_nearly_singular_ = false;
  unsigned int n_failures_ = 0; ///< of the iterative solver in succession
  unsigned int pause_ = 0;      ///< matrices for which it is not tried
  bool has_reported_memory_ = false, is_ill_conditioned_ = false;
  unsigned int n_factorized_ = 0; ///< directly
  double norm_ = 0.;              ///< |A|, as factorised directly
  double condition_ = 0.;         ///< at least, of the same
  std::string name_, failure_;
  DiagnosticList diagnostics_;
  HeldMemory matrix_memory_{Capability::matrix}, unsymmetric_memory_{Capability::unsymmetric_matrix},
      iterative_memory_{Capability::iterative_solver};

  void note_memory();
};

} // namespace billet

#endif
