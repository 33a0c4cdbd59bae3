// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/algebra/iterative_solver.h"

#include "billet/algebra/epetra.h"

#include <AztecOO.h>
#include <Epetra_Comm.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_IntVector.h>
#include <Epetra_Map.h>
#include <Epetra_Operator.h>
#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace billet {

namespace {

/// Limits of linear solutions, beside IterativeSolver::Settings.
struct IterativeSolverLimits {
  /// Iterations beyond those that the pace of a kept preconditioner lets expect.
  static constexpr double spare_iterations = 10.;
  /// Maximum number of starts from the true residual, and the part of it that each has to go below.
  static constexpr unsigned int max_attempts = 3;
  static constexpr double progress = 0.5;
  /// Tolerance of the recursive residual over that of the true one.
  static constexpr double of_recursive = 0.9;
  /// Maximum number of directions that GMRES keeps.
  static constexpr unsigned int max_directions = 100;
};

/// Base class of Trilinos operators that only apply an inverse.
class Preconditioner : public Epetra_Operator {
public:
  explicit Preconditioner(const Epetra_Map &map) : map_(map) {}
  int SetUseTranspose(bool) override { return -1; }
  int Apply(const Epetra_MultiVector &, Epetra_MultiVector &) const override { return -1; }
  double NormInf() const override { return 0.; }
  bool UseTranspose() const override { return false; }
  bool HasNormInf() const override { return false; }
  const Epetra_Comm &Comm() const override { return map_.Comm(); }
  const Epetra_Map &OperatorDomainMap() const override { return map_; }
  const Epetra_Map &OperatorRangeMap() const override { return map_; }

private:
  const Epetra_Map &map_;
};

double sum(const Epetra_Comm &comm, double value) {
  double result = 0.;
  comm.SumAll(&value, &result, 1);
  return result;
}

double norm(const Epetra_MultiVector &v) {
  double result = 0.;
  v.Norm2(&result);
  return result;
}

/// Returns the value of AztecOO's option AZ_solver.
int aztec_solver(const IterativeMethod method) {
  switch (method) {
  case IterativeMethod::conjugate_gradients:
    return AZ_cg;
  case IterativeMethod::gmres:
    return AZ_gmres;
  }
  return AZ_gmres;
}

} // namespace

/// Contact dofs: the factorised block A_ΓΓ, and the stiffness of contacts in it.
class IterativeSolver::ContactBlock {
public:
  /// `matrix`: without the contacts.
  ContactBlock(const Epetra_CrsMatrix &matrix, const std::vector<int> &dofs) : matrix_(&matrix), dofs_(dofs) {
    rows_.reserve(dofs.size());
    for (const int row : dofs)
      rows_.push_back(row_of(row));
    map_ = std::make_unique<Epetra_Map>(-1, static_cast<int>(dofs.size()), 0, matrix.Comm());
    Epetra_IntVector owned(matrix.RowMap()), numbers(matrix.ColMap());
    owned.PutValue(-1);
    for (std::size_t i = 0; i < dofs.size(); ++i)
      owned[dofs[i]] = map_->GID(static_cast<int>(i));
    numbers.PutValue(-1);
    if (matrix.Importer() != nullptr)
      numbers.Import(owned, *matrix.Importer(), Insert);
    else
      std::copy(owned.Values(), owned.Values() + owned.MyLength(), numbers.Values());
    number_.assign(numbers.Values(), numbers.Values() + numbers.MyLength());
  }

  bool is_empty() const { return map_->NumGlobalElements() == 0; }
  double memory() const { return solver_ ? solver_->memory() : 0.; }
  const std::string &failure() const { return solver_->failure(); }

  /// Copies A_ΓΓ and factorises it.
  bool factorize(const bool symmetric, MPI_Comm communicator) {
    const dealii::IndexSet owned(*map_);
    block_ = std::make_unique<Matrix>(owned, communicator);
    std::vector<dealii::types::global_dof_index> columns;
    std::vector<double> values;
    for (std::size_t i = 0; i < dofs_.size(); ++i) {
      columns.clear();
      values.clear();
      for_each_entry(dofs_[i], [&](const int column, const double value) {
        if (number_[static_cast<std::size_t>(column)] >= 0) {
          columns.push_back(
              static_cast<dealii::types::global_dof_index>(number_[static_cast<std::size_t>(column)]));
          values.push_back(value);
        }
      });
      block_->set(owned.nth_index_in_set(i), columns, values);
    }
    block_->compress(dealii::VectorOperation::insert);
    b_.reinit(owned, communicator);
    x_.reinit(owned, communicator);
    solver_ = make_direct_solver(symmetric ? DirectMethod::mumps_symmetric : DirectMethod::mumps, *block_,
                                 communicator);
    return solver_->factorize();
  }

  /// Returns a copy of A = K + C with K + θ C instead, where θ makes C's diagonal, on average,
  /// `stiffness` times that of K.
  std::unique_ptr<Epetra_CrsMatrix> soften(const double stiffness) const {
    double ratio = 0., n = 0.;
    for (std::size_t i = 0; i < dofs_.size(); ++i) {
      double before = 0., now = 0.;
      std::size_t k = 0;
      for_each_entry(dofs_[i], [&](const int column, const double value) {
        if (matrix_->ColMap().GID(column) == matrix_->RowMap().GID(dofs_[i])) {
          before = rows_[i][k];
          now = value;
        }
        ++k;
      });
      if (before > 0. && now > before * (1. + 1e-12)) {
        ratio += (now - before) / before;
        n += 1.;
      }
    }
    ratio = sum(matrix_->Comm(), ratio);
    n = sum(matrix_->Comm(), n);
    const double softening = n > 0. ? std::max(0., 1. - stiffness * n / ratio) : 0.;
    auto result = std::make_unique<Epetra_CrsMatrix>(*matrix_);
    for (std::size_t i = 0; i < dofs_.size(); ++i) {
      int size = 0;
      double *values = nullptr;
      int *columns = nullptr;
      result->ExtractMyRowView(dofs_[i], size, values, columns);
      for (int k = 0; k < size; ++k)
        values[k] -= softening * (values[k] - rows_[i][static_cast<std::size_t>(k)]);
    }
    return result;
  }

  /// z += R_Γᵀ A_ΓΓ⁻¹ R_Γ (r − A z)
  void correct(const Epetra_Vector &r, Epetra_Vector &z) const {
    // Only the rows of Γ are needed.
    const Epetra_Vector *ghosted = &z;
    if (matrix_->Importer() != nullptr) {
      if (ghosted_ == nullptr)
        ghosted_ = std::make_unique<Epetra_Vector>(matrix_->ColMap());
      ghosted_->Import(z, *matrix_->Importer(), Insert);
      ghosted = ghosted_.get();
    }
    for (std::size_t i = 0; i < dofs_.size(); ++i) {
      double value = r[dofs_[i]];
      for_each_entry(dofs_[i], [&](const int column, const double a) { value -= a * (*ghosted)[column]; });
      b_.begin()[i] = value;
    }
    solver_->solve(b_, x_, 0.);
    for (std::size_t i = 0; i < dofs_.size(); ++i)
      z[dofs_[i]] += x_.begin()[i];
  }

private:
  template <class Function> void for_each_entry(const int row, const Function &f) const {
    int size = 0;
    double *values = nullptr;
    int *columns = nullptr;
    matrix_->ExtractMyRowView(row, size, values, columns);
    for (int k = 0; k < size; ++k)
      f(columns[k], values[k]);
  }
  std::vector<double> row_of(const int row) const {
    std::vector<double> result;
    for_each_entry(row, [&result](int, const double value) { result.push_back(value); });
    return result;
  }

  const Epetra_CrsMatrix *matrix_;
  std::vector<int> dofs_;                 ///< by local row
  std::vector<std::vector<double>> rows_; ///< of K
  std::unique_ptr<Epetra_Map> map_;       ///< of Γ, with its own numbering
  std::vector<int> number_;               ///< of the matrix's columns in Γ; −1: not in Γ
  std::unique_ptr<Matrix> block_;
  std::unique_ptr<LinearSolver> solver_;
  mutable Vector b_, x_; ///< of Γ
  mutable std::unique_ptr<Epetra_Vector> ghosted_;
};

/// Smoothed aggregation, followed by the direct solution for the contact dofs.
class IterativeSolver::Multigrid final : public Preconditioner {
public:
  Multigrid(const Settings &settings, const Epetra_CrsMatrix &matrix, const NodalGeometry &geometry,
            const ContactBlock *contact)
      : Preconditioner(matrix.RowMap()), contact_(contact) {
    const Epetra_CrsMatrix *smooth = &matrix;
    if (contact != nullptr && settings.contact_stiffness > 0.) {
      softened_ = contact->soften(settings.contact_stiffness);
      smooth = softened_.get();
    }
    make_modes(geometry, matrix.Comm());
    Teuchos::ParameterList options;
    ML_Epetra::SetDefaults("SA", options);
    options.set("ML output", 0);
    options.set("PDE equations", 3);
    options.set("null space: type", "pre-computed");
    options.set("null space: dimension", n_modes);
    options.set("null space: vectors", modes_.data());
    options.set("null space: add default vectors", false);
    options.set("aggregation: type", "Uncoupled");
    options.set("smoother: type", "Chebyshev");
    options.set("smoother: sweeps", 2);
    options.set("coarse: max size", 1000);
    ml_ = std::make_unique<ML_Epetra::MultiLevelPreconditioner>(*smooth, options, true);
  }

  int ApplyInverse(const Epetra_MultiVector &r, Epetra_MultiVector &z) const override {
    if (contact_ == nullptr)
      return ml_->ApplyInverse(r, z);
    const Epetra_Vector residual(*r(0)); // Aztec may pass the same vector twice
    const int error = ml_->ApplyInverse(residual, z);
    if (error == 0)
      contact_->correct(residual, *z(0));
    return error;
  }
  /// Sets the contact dofs of another matrix while the hierarchy of an earlier one is kept.
  void set_contact(const ContactBlock *contact) { contact_ = contact; }
  const char *Label() const override { return "smoothed aggregation"; }
  bool is_ready() const { return ml_->IsPreconditionerComputed(); }
  double memory() const {
    // Counts entries with their columns: of the softened matrix, the coarser ones, and the transfer
    // between them.
    double entries = softened_ != nullptr ? softened_->NumMyNonzeros() : 0.;
    const ML *levels = ml_->GetML();
    for (int level = 0; level < levels->ML_num_levels; ++level) {
      entries += std::max(0, levels->Pmat[level].N_nonzeros) + std::max(0, levels->Rmat[level].N_nonzeros);
      if (level != levels->ML_finest_level)
        entries += std::max(0, levels->Amat[level].N_nonzeros);
    }
    return sum(Comm(), 12. * entries + 8. * static_cast<double>(modes_.size()));
  }

private:
  static constexpr int n_modes = 6;

  void make_modes(const NodalGeometry &geometry, const Epetra_Comm &comm) {
    const std::size_t n = geometry.positions.size();
    std::array<double, 3> centre{};
    std::array<double, 4> sums{};
    for (std::size_t i = 0; i < n; ++i)
      sums[i % 3] += geometry.positions[i];
    sums[3] = static_cast<double>(n) / 3.;
    std::array<double, 4> all{};
    comm.SumAll(sums.data(), all.data(), 4);
    for (unsigned int c = 0; c < 3; ++c)
      centre[c] = all[c] / all[3];
    double square = 0.;
    for (std::size_t i = 0; i < n; ++i)
      square += std::pow(geometry.positions[i] - centre[i % 3], 2);
    const double size = std::sqrt(sum(comm, square) / all[3]);
    modes_.assign(n_modes * n, 0.);
    for (std::size_t i = 0; i < n; i += 3) {
      std::array<double, 3> x{};
      for (unsigned int c = 0; c < 3; ++c)
        x[c] = (geometry.positions[i + c] - centre[c]) / size;
      for (unsigned int c = 0; c < 3; ++c) {
        const unsigned int d = (c + 1) % 3, e = (c + 2) % 3;
        modes_[c * n + i + c] = 1.;
        // about axis c: e_c × x
        modes_[(3 + c) * n + i + d] = -x[e];
        modes_[(3 + c) * n + i + e] = x[d];
      }
      for (unsigned int c = 0; c < 3; ++c)
        if (geometry.constrained[i + c])
          for (unsigned int mode = 0; mode < n_modes; ++mode)
            modes_[mode * n + i + c] = 0.;
    }
  }

  const ContactBlock *contact_;
  std::unique_ptr<Epetra_CrsMatrix> softened_;
  std::vector<double> modes_;
  std::unique_ptr<ML_Epetra::MultiLevelPreconditioner> ml_;
};

IterativeSolver::IterativeSolver(const Settings &settings, const Matrix &matrix, MPI_Comm communicator)
    : settings_(settings), matrix_(&matrix), communicator_(communicator) {}

IterativeSolver::~IterativeSolver() = default;

void IterativeSolver::release() {
  multigrid_.reset(); // it refers to the block
  contact_.reset();
  started_.reset();
}

void IterativeSolver::set_geometry(NodalGeometry geometry) { geometry_ = std::move(geometry); }

void IterativeSolver::start_contact(const std::vector<int> &dofs) {
  started_.reset();
  if (!settings_.solve_contact)
    return;
  started_ = std::make_unique<ContactBlock>(matrix_->trilinos_matrix(), dofs);
  if (started_->is_empty())
    started_.reset();
}

bool IterativeSolver::factorize() {
  // Keep the hierarchy if the last solve converged well: it is expensive, and a Newton iteration
  // changes little.
  const bool keeps_pace =
      multigrid_ != nullptr && last_pace_ >= settings_.min_pace * fresh_pace_ && fresh_pace_ > 0.;
  if (!keeps_pace)
    multigrid_.reset();
  contact_ = std::move(started_);
  if (contact_ != nullptr && !contact_->factorize(requires_symmetry(settings_.method), communicator_)) {
    multigrid_.reset();
    failure_ = "the stiffness of the contact dofs cannot be factorised: " + contact_->failure();
    return false;
  }
  is_lagging_ = keeps_pace;
  if (!is_lagging_)
    return renew();
  multigrid_->set_contact(contact_.get());
  return true;
}

bool IterativeSolver::renew() {
  is_lagging_ = false;
  fresh_pace_ = last_pace_ = 0.;
  multigrid_.reset();
  multigrid_ = std::make_unique<Multigrid>(settings_, matrix_->trilinos_matrix(), geometry_, contact_.get());
  ++n_hierarchies_;
  if (multigrid_->is_ready())
    return true;
  multigrid_.reset();
  failure_ = "the set-up of multigrid failed";
  return false;
}

bool IterativeSolver::solve(const Vector &b, Vector &x, const double relative_tolerance) {
  if (!is_lagging_)
    return iterate(b, x, relative_tolerance, settings_.max_iterations);
  const double expected = -std::log(relative_tolerance) / (settings_.min_pace * fresh_pace_);
  const double maximum = std::min(expected + IterativeSolverLimits::spare_iterations,
                                  static_cast<double>(settings_.max_iterations));
  return iterate(b, x, relative_tolerance, static_cast<unsigned int>(maximum)) ||
         (renew() && iterate(b, x, relative_tolerance, settings_.max_iterations));
}

bool IterativeSolver::iterate(const Vector &rhs, Vector &solution, const double relative_tolerance,
                              const unsigned int max_iterations) {
  const Epetra_CrsMatrix &A = matrix_->trilinos_matrix();
  const Epetra_Vector &b = as_epetra(rhs);
  Epetra_Vector &x = as_epetra(solution);
  x.PutScalar(0.);
  relative_residual_ = 0.;
  const double size = norm(b);
  if (size == 0.)
    return true;
  if (contact_ != nullptr)
    contact_->correct(b, x);
  Epetra_Vector residual(b);
  const auto compute_residual = [&] {
    A.Multiply(false, x, residual);
    residual.Update(1., b, -1.);
    relative_residual_ = norm(residual) / size;
  };
  compute_residual();
  const double start = relative_residual_;
  // The recursive residual may be smaller than the true one: then the iterations continue from
  // there.
  unsigned int left = max_iterations;
  for (unsigned int attempt = 0;
       relative_residual_ > relative_tolerance && attempt < IterativeSolverLimits::max_attempts && left > 0;
       ++attempt) {
    const double before = relative_residual_;
    // Aztec takes non-const pointers, but changes neither the matrix nor the right-hand side.
    AztecOO solver(const_cast<Epetra_CrsMatrix *>(&A), &x, // NOLINT(cppcoreguidelines-pro-type-const-cast)
                   const_cast<Epetra_Vector *>(&b));       // NOLINT(cppcoreguidelines-pro-type-const-cast)
    solver.SetAztecOption(AZ_output, AZ_none);
    solver.SetAztecOption(AZ_diagnostics, AZ_none);
    solver.SetPrecOperator(multigrid_.get());
    solver.SetAztecOption(AZ_conv, AZ_rhs);
    solver.SetAztecOption(AZ_solver, aztec_solver(settings_.method));
    solver.SetAztecOption(AZ_kspace, static_cast<int>(std::min(left, IterativeSolverLimits::max_directions)));
    solver.Iterate(static_cast<int>(left), IterativeSolverLimits::of_recursive * relative_tolerance);
    iterations_ += static_cast<unsigned int>(solver.NumIters());
    left -= std::min(left, static_cast<unsigned int>(solver.NumIters()));
    compute_residual();
    if (!(relative_residual_ < IterativeSolverLimits::progress * before))
      break;
  }
  if (relative_residual_ <= relative_tolerance) {
    if (left < max_iterations && relative_residual_ > 0.)
      last_pace_ = std::log(start / relative_residual_) / (max_iterations - left);
    if (fresh_pace_ == 0.)
      fresh_pace_ = last_pace_;
    return true;
  }
  std::ostringstream text;
  text.precision(2);
  text << name() << " leaves " << relative_residual_ << " of the right-hand side after "
       << max_iterations - left << " iterations; allowed is " << relative_tolerance;
  failure_ = text.str();
  return false;
}

std::string IterativeSolver::name() const {
  return std::string(name_of(settings_.method)) + " with multigrid";
}

unsigned int IterativeSolver::take_iterations() {
  const unsigned int result = iterations_;
  iterations_ = 0;
  return result;
}

double IterativeSolver::memory() const {
  return (multigrid_ ? multigrid_->memory() : 0.) + (contact_ ? contact_->memory() : 0.);
}

} // namespace billet
