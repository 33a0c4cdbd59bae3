// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_TANGENT_SOLVER_H
#define BILLET_SOLVE_TANGENT_SOLVER_H

#include "billet/algebra/iterative_solver.h"
#include "billet/diagnostics.h"
#include "billet/parameters/control.h"
#include "billet/solve/condition_watch.h"
#include "billet/usage.h"

#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Returns an estimate of the memory of a direct solver on one rank [bytes]; many ranks need more.
/// It was measured with MUMPS for two blocks of 50 000 to 500 000 dofs:
/// doc/results/linear-solvers.md. The fill of solids grows as n^(4/3).
double direct_memory(double n_dofs, bool symmetric);

/// Linear solver of a scene: a direct one, or an iterative one that a direct one replaces for every
/// matrix with which it stagnates.
class TangentSolver {
public:
  /// Resolves `automatic`. `matrix` must outlive the solver.
  TangentSolver(const parameters::Solver &settings, bool symmetric, const Matrix &matrix,
                MPI_Comm communicator);

  /// Releases the matrix. Call it before the matrix is destroyed or gets another pattern, ...
  void release();
  /// ... then set the next one.
  void set_matrix(const Matrix &matrix);

  /// Sets whether the next matrices are nearly singular: a direct solver then replaces an iterative
  /// one.
  void expect_nearly_singular(const bool is) { is_nearly_singular_ = is; }
  bool is_iterative() const { return iterative_ != nullptr; }
  /// Pass these to the iterative solver; see IterativeSolver. They require is_iterative().
  void set_geometry(NodalGeometry geometry);
  void start_contact(const std::vector<int> &dofs);

  /// Prepares solves with the present matrix. Returns false on failure, like solve(), on all ranks.
  bool factorize();
  /// Solves with |b − A x| <= relative_tolerance |b|.
  bool solve(const Vector &b, Vector &x, double relative_tolerance);

  const std::string &name() const { return name_; }
  const std::string &failure() const { return failure_; }
  /// Returns the iterations of an iterative solver since the last call.
  unsigned int take_iterations();
  /// Returns messages since the last call: the memory of an iterative solver, and its replacement
  /// by a direct one.
  DiagnosticList take_diagnostics();
  /// Returns a warning if the matrix factorised last is ill-conditioned; once.
  DiagnosticList check_condition();

private:
  /// When the iterative solver is tried again after failures: less and less often.
  struct Retries {
    unsigned int n_failures = 0; ///< in succession
    unsigned int pause = 0;      ///< remaining matrices for which it is not tried

    void add_failure();
    /// Returns whether the next matrix is one of the pause, which it shortens.
    bool skips();
  };
  struct Memory {
    HeldMemory matrix{Capability::matrix}, unsymmetric{Capability::unsymmetric_matrix},
        iterative{Capability::iterative_solver};
  };

  bool factorize_directly();
  bool fall_back();
  void note_memory();

  DirectMethod direct_method_;
  bool symmetric_;
  const Matrix *matrix_;
  MPI_Comm communicator_;
  std::unique_ptr<IterativeSolver> iterative_;
  std::unique_ptr<LinearSolver> direct_;
  bool is_direct_now_;
  bool is_nearly_singular_ = false;
  Retries retries_;
  bool has_reported_memory_ = false;
  ConditionWatch condition_; ///< of what is factorised directly
  std::string name_, failure_;
  DiagnosticList diagnostics_;
  Memory memory_;
};

} // namespace billet

#endif
