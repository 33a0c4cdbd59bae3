// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/tangent_solver.h"

#include "billet/diagnostic_kinds.h"
#include "billet/spent_time.h"

#include <deal.II/base/mpi.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace billet {

double direct_memory(const double n_dofs, const bool symmetric) {
  constexpr double of_symmetric = 220., of_unsymmetric = 410.; // bytes for one unknown, measured
  return (symmetric ? of_symmetric : of_unsymmetric) * std::pow(n_dofs, 4. / 3.);
}

namespace {

double machine_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// `wanted`: none for an automatic choice.
LinearMethod choose(const std::optional<LinearMethod> &wanted, const bool symmetric, const Matrix &matrix,
                    MPI_Comm communicator) {
  if (wanted)
    return *wanted;
  const double n_dofs = matrix.m();
  // The smallest machine of all ranks counts.
  const double minimum = dealii::Utilities::MPI::min(machine_memory(), communicator);
  constexpr double part_of_memory = 0.5;
  if (n_dofs > parameters::Solver::max_direct_dofs ||
      direct_memory(n_dofs, symmetric) > part_of_memory * minimum)
    return default_iterative_method(symmetric);
  return default_direct_method(symmetric);
}

} // namespace

TangentSolver::TangentSolver(const parameters::Solver &settings, const bool symmetric, const Matrix &matrix,
                             MPI_Comm communicator)
    : symmetric_(symmetric), matrix_(&matrix), communicator_(communicator) {
  const LinearMethod method = choose(settings.linear_solver.value, symmetric, matrix, communicator);
  const auto *direct = std::get_if<DirectMethod>(&method);
  direct_method_ = direct != nullptr ? *direct : default_direct_method(symmetric);
  is_direct_now_ = direct != nullptr;
  if (const auto *iterative_method = std::get_if<IterativeMethod>(&method)) {
    IterativeSolver::Settings iterative;
    iterative.method = *iterative_method;
    iterative.max_iterations = settings.max_linear_iterations;
    iterative_ = std::make_unique<IterativeSolver>(iterative, matrix, communicator);
    name_ = iterative_->name();
  } else {
    direct_ = make_direct_solver(direct_method_, matrix, communicator);
    name_ = direct_->name();
  }
}

void TangentSolver::release() {
  if (iterative_)
    iterative_->release();
  direct_.reset();
}

void TangentSolver::set_matrix(const Matrix &matrix) {
  matrix_ = &matrix;
  if (iterative_)
    iterative_->set_matrix(matrix);
}

void TangentSolver::set_geometry(NodalGeometry geometry) { iterative_->set_geometry(std::move(geometry)); }

void TangentSolver::start_contact(const std::vector<int> &dofs) { iterative_->start_contact(dofs); }

void TangentSolver::Retries::add_failure() {
  constexpr unsigned int max_doublings = 5;
  ++n_failures;
  pause = (1u << std::min(n_failures - 1, max_doublings)) - 1;
}

bool TangentSolver::Retries::skips() {
  if (pause == 0)
    return false;
  --pause;
  return true;
}

bool TangentSolver::factorize_directly() {
  if (!direct_)
    direct_ = make_direct_solver(direct_method_, *matrix_, communicator_);
  is_direct_now_ = true;
  if (direct_->factorize()) {
    condition_.start(*matrix_, *direct_);
    note_memory();
    return true;
  }
  failure_ = direct_->failure();
  return false;
}

void TangentSolver::note_memory() {
  // For factors only the sum over all ranks is known.
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator_);
  const auto share = [n_ranks](const double bytes) { return static_cast<std::size_t>(bytes / n_ranks); };
  const std::size_t factors = direct_ ? share(direct_->memory()) : 0;
  memory_.matrix.set(count_owned_entries(*matrix_) * (sizeof(double) + sizeof(int)) +
                     (symmetric_ ? factors : 0));
  memory_.unsymmetric.set(symmetric_ ? 0 : factors);
  memory_.iterative.set(is_direct_now_ ? 0 : share(iterative_->memory()));
}

bool TangentSolver::factorize() {
  const TimedWork timed(Work::unsymmetric_matrix, !symmetric_);
  failure_.clear();
  Usage::count(Capability::matrix, count_owned_entries(*matrix_));
  Usage::count_if(!symmetric_, Capability::unsymmetric_matrix, count_owned_entries(*matrix_));
  if (!iterative_)
    return factorize_directly();
  if (is_nearly_singular_) {
    diagnostics_.emplace_back(
        diagnostic::direct_solver,
        "While viscous forces alone hold rigid-body modes, a direct solver replaces the "
        "iterative one");
    return factorize_directly();
  }
  if (retries_.skips())
    return factorize_directly();
  direct_.reset(); // both together would need too much memory
  is_direct_now_ = false;
  if (!iterative_->factorize())
    return fall_back();
  note_memory();
  if (!has_reported_memory_) {
    std::ostringstream text;
    text.precision(3);
    text << iterative_->name() << " takes " << 1e-6 * iterative_->memory() << " MB beside the matrix";
    diagnostics_.push_back(
        Diagnostic(diagnostic::solver_memory, text.str()).value("bytes", iterative_->memory()));
    has_reported_memory_ = true;
  }
  return true;
}

bool TangentSolver::fall_back() {
  iterative_->release();
  retries_.add_failure();
  diagnostics_.emplace_back(diagnostic::direct_solver,
                            iterative_->failure() + ": a direct solver replaces it whenever that happens");
  return factorize_directly();
}

bool TangentSolver::solve(const Vector &b, Vector &x, const double relative_tolerance) {
  const TimedWork timed(Work::unsymmetric_matrix, !symmetric_);
  if (!is_direct_now_) {
    if (iterative_->solve(b, x, relative_tolerance)) {
      retries_.n_failures = 0;
      return true;
    }
    if (!fall_back())
      return false;
  }
  if (direct_->solve(b, x, relative_tolerance)) {
    condition_.update(b, x);
    return true;
  }
  failure_ = direct_->failure();
  return false;
}

DiagnosticList TangentSolver::check_condition() {
  return is_direct_now_ ? condition_.check() : DiagnosticList();
}

unsigned int TangentSolver::take_iterations() {
  if (!iterative_)
    return 0;
  const unsigned int n = iterative_->take_iterations();
  Usage::count_if(n > 0, Capability::iterative_solver, n);
  return n;
}

DiagnosticList TangentSolver::take_diagnostics() { return std::exchange(diagnostics_, {}); }

} // namespace billet
