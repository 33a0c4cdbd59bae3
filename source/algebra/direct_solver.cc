// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/algebra/direct_solver.h"

#include "billet/algebra/epetra.h"
#include "billet/errors.h"

#include <Amesos.h>
#include <Amesos_BaseSolver.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_LinearProblem.h>
#include <Teuchos_ParameterList.hpp>
#include <dmumps_c.h>

#include <algorithm>
#include <array>
#include <vector>

namespace billet {

namespace {

/// Trilinos' interface to direct solvers: KLU, which it always has.
class AmesosSolver final : public LinearSolver {
public:
  AmesosSolver(const std::string &amesos_name, const Matrix &matrix) : name_(amesos_name) {
    // Amesos takes non-const pointers, but changes neither the matrix nor the right-hand side.
    problem_.SetOperator(const_cast<Epetra_CrsMatrix *>(
        &matrix.trilinos_matrix())); // NOLINT(cppcoreguidelines-pro-type-const-cast)
    Amesos factory;
    solver_.reset(factory.Create(amesos_name, problem_));
    if (solver_ == nullptr)
      throw InputError("'Linear solver' names a solver that this Trilinos lacks: " + amesos_name +
                       "; allowed is another solver, such as KLU");
    Teuchos::ParameterList options;
    options.set("PrintTiming", false);
    options.set("PrintStatus", false);
    solver_->SetParameters(options);
  }

  bool factorize() override {
    if (!is_analysed_ && solver_->SymbolicFactorization() != 0) {
      failure_ = "the symbolic factorisation failed";
      return false;
    }
    is_analysed_ = true;
    if (solver_->NumericFactorization() != 0) {
      failure_ = "the matrix is singular or the factorisation ran out of memory";
      return false;
    }
    return true;
  }

  bool solve(const Vector &b, Vector &x, double) override {
    problem_.SetLHS(&as_epetra(x));
    problem_.SetRHS(
        const_cast<Epetra_Vector *>(&as_epetra(b))); // NOLINT(cppcoreguidelines-pro-type-const-cast)
    if (solver_->Solve() != 0) {
      failure_ = "back substitution failed";
      return false;
    }
    return true;
  }

  std::string name() const override { return name_ + " (unsymmetric)"; }

private:
  std::string name_;
  Epetra_LinearProblem problem_;
  std::unique_ptr<Amesos_BaseSolver> solver_;
  bool is_analysed_ = false;
};

/// Direct interface to MUMPS: in its symmetric indefinite form, LDLᵀ of the upper triangle, which
/// Amesos does not offer, or LU of the whole matrix. If MUMPS underestimates its memory, it is
/// called again with more.
class MumpsSolver final : public LinearSolver {
public:
  MumpsSolver(const bool is_symmetric, const Matrix &matrix, MPI_Comm communicator)
      : is_symmetric_(is_symmetric), matrix_(matrix.trilinos_matrix()), communicator_(communicator) {
    MPI_Comm_rank(communicator, &rank_);
    mumps_.par = 1;
    mumps_.sym = is_symmetric ? 2 : 0;
    mumps_.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(communicator));
    call(job_initialize);
    for (const int output_stream : {1, 2, 3, 4})
      control(output_stream) = output_stream == 4 ? 0 : -1;
    control(distribution) = 3; // each rank gives its rows
    control(spare_memory) = 60;
    collect_pattern();
    MPI_Allgather(&n_local_rows_, 1, MPI_INT, make_room(counts_), 1, MPI_INT, communicator);
    offsets_.assign(counts_.size(), 0);
    for (std::size_t i = 1; i < counts_.size(); ++i)
      offsets_[i] = offsets_[i - 1] + counts_[i - 1];
  }
  MumpsSolver(const MumpsSolver &) = delete;
  MumpsSolver &operator=(const MumpsSolver &) = delete;
  ~MumpsSolver() override { call(job_end); }

  bool factorize() override {
    collect_values();
    if (!is_analysed_ && !call(job_analyze))
      return false;
    is_analysed_ = true;
    // MUMPS reports if its estimate of the memory was too small.
    for (int attempt = 0; attempt < 4; ++attempt) {
      if (call(job_factorize))
        return true;
      // Work arrays of integers and reals, the stack, buffers (MUMPS users' guide, "Error
      // diagnostics").
      constexpr std::array<int, 6> too_small = {-8, -9, -11, -12, -14, -15};
      if (std::find(too_small.begin(), too_small.end(), mumps_.infog[0]) == too_small.end())
        return false;
      control(spare_memory) *= 2;
    }
    return false;
  }

  bool solve(const Vector &b, Vector &x, double) override {
    // The right-hand side is gathered on the first rank, which owns the first rows.
    std::vector<double> whole(rank_ == 0 ? static_cast<std::size_t>(matrix_.NumGlobalRows()) : 0);
    MPI_Gatherv(b.begin(), n_local_rows_, MPI_DOUBLE, whole.data(), counts_.data(), offsets_.data(),
                MPI_DOUBLE, 0, communicator_);
    mumps_.rhs = whole.data();
    const bool success = call(job_solve);
    MPI_Scatterv(whole.data(), counts_.data(), offsets_.data(), MPI_DOUBLE, x.begin(), n_local_rows_,
                 MPI_DOUBLE, 0, communicator_);
    return success;
  }

  std::string name() const override { return is_symmetric_ ? "MUMPS (symmetric)" : "MUMPS (unsymmetric)"; }
  double memory() const override {
    // INFOG(19): allocated on all ranks, in 1e6 bytes. INFOG(29): entries of the factors; if
    // negative, millions of them.
    const double n_entries = mumps_.infog[28] < 0 ? -1e6 * mumps_.infog[28] : mumps_.infog[28];
    return std::max(1e6 * mumps_.infog[18], sizeof(double) * n_entries);
  }

private:
  static constexpr int job_initialize = -1, job_end = -2, job_analyze = 1, job_factorize = 2, job_solve = 3;
  static constexpr int spare_memory = 14, distribution = 18; ///< of control(); memory in per cent

  // The numbers are those of MUMPS's manual.
  MUMPS_INT &control(const int number) { return mumps_.icntl[number - 1]; }

  bool call(const int job) {
    mumps_.job = job;
    dmumps_c(&mumps_);
    if (mumps_.infog[0] < 0)
      failure_ = mumps_.infog[0] == -10 ? "the matrix is singular"
                                        : "MUMPS stops with INFOG(1) = " + std::to_string(mumps_.infog[0]) +
                                              ", INFOG(2) = " + std::to_string(mumps_.infog[1]);
    return mumps_.infog[0] >= 0;
  }

  int *make_room(std::vector<int> &counts) const {
    int n_ranks = 1;
    MPI_Comm_size(communicator_, &n_ranks);
    counts.resize(static_cast<std::size_t>(n_ranks));
    return counts.data();
  }

  template <class Function> void for_each_entry(const Function &f) const {
    for (int row = 0; row < matrix_.NumMyRows(); ++row) {
      int n = 0;
      double *values = nullptr;
      int *columns = nullptr;
      matrix_.ExtractMyRowView(row, n, values, columns);
      const int global_row = matrix_.RowMap().GID(row);
      for (int k = 0; k < n; ++k) {
        const int global_column = matrix_.ColMap().GID(columns[k]);
        if (!is_symmetric_ || global_column >= global_row)
          f(global_row, global_column, values[k]);
      }
    }
  }

  void collect_pattern() {
    for_each_entry([this](const int row, const int column, double) {
      rows_.push_back(row + 1);
      columns_.push_back(column + 1);
    });
    values_.resize(rows_.size());
    n_local_rows_ = matrix_.NumMyRows();
    mumps_.n = matrix_.NumGlobalRows();
    mumps_.nnz_loc = static_cast<MUMPS_INT8>(rows_.size());
    mumps_.irn_loc = rows_.data();
    mumps_.jcn_loc = columns_.data();
    mumps_.a_loc = values_.data();
    mumps_.nrhs = 1;
    mumps_.lrhs = mumps_.n;
  }

  void collect_values() {
    std::size_t next = 0;
    for_each_entry([this, &next](int, int, const double value) { values_[next++] = value; });
  }

  bool is_symmetric_;
  const Epetra_CrsMatrix &matrix_;
  MPI_Comm communicator_;
  int rank_ = 0;
  int n_local_rows_ = 0;
  std::vector<int> counts_, offsets_;
  DMUMPS_STRUC_C mumps_{};
  std::vector<MUMPS_INT> rows_, columns_;
  std::vector<double> values_;
  bool is_analysed_ = false;
};

} // namespace

std::unique_ptr<LinearSolver> make_direct_solver(const DirectMethod method, const Matrix &matrix,
                                                 MPI_Comm communicator) {
  switch (method) {
  case DirectMethod::mumps_symmetric:
  case DirectMethod::mumps:
    return std::make_unique<MumpsSolver>(requires_symmetry(method), matrix, communicator);
  case DirectMethod::klu:
    return std::make_unique<AmesosSolver>("Amesos_Klu", matrix);
  }
  return nullptr;
}

} // namespace billet
