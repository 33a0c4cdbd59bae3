// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/tangent_matrix.h"

#include "billet/forces/surface_coupling.h"
#include "billet/solve/implicit/step_state.h"

#include <deal.II/dofs/dof_tools.h>

namespace billet {

namespace {

NodalGeometry collect_geometry(const Discretization &discretization, const Constraints &constraints) {
  const auto &owned = discretization.owned_dofs();
  NodalGeometry geometry;
  geometry.positions.resize(owned.n_elements());
  geometry.constrained.resize(owned.n_elements());
  for (const auto &cell : discretization.dof_handler().active_cell_iterators())
    if (!cell->is_artificial())
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int i = 0; i < 3; ++i) {
          const DofIndex dof = cell->vertex_dof_index(v, i);
          if (owned.is_element(dof))
            geometry.positions[owned.index_within_set(dof)] = cell->vertex(v)[i];
        }
  for (const auto &line : constraints.get_lines())
    if (owned.is_element(line.index))
      geometry.constrained[owned.index_within_set(line.index)] = true;
  return geometry;
}

} // namespace

void TangentMatrix::build(const bool couplings_are_known) {
  const auto &owned = discretization_.owned_dofs();
  dealii::IndexSet written = discretization_.relevant_dofs();
  for (auto &contact : contacts_) {
    if (!couplings_are_known)
      contact.with_matrix().couplings().find();
    contact.with_matrix().couplings().add_foreign_dofs(written);
  }
  SparsityPattern pattern(owned, owned, written, discretization_.communicator());
  dealii::DoFTools::make_sparsity_pattern(
      discretization_.dof_handler(), pattern, supports_.homogeneous(), false,
      dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()));
  for (const auto &contact : contacts_)
    contact.with_matrix().couplings().add_entries(pattern);
  add_surface_couplings(scene_, discretization_, supports_.homogeneous(), pattern);
  pattern.compress();
  if (linear_) {
    linear_->release();
    matrix_.reinit(pattern);
    linear_->set_matrix(matrix_);
    return;
  }
  matrix_.reinit(pattern);
  parameters::Solver settings = scene_.parameters().solver;
  const bool has_own_tangent = kind_ == scene_.contact_tangent();
  std::optional<LinearMethod> &method = settings.linear_solver.value;
  if (!has_own_tangent && method && requires_symmetry(*method))
    method.reset();
  linear_ =
      std::make_unique<TangentSolver>(settings, has_own_tangent && !scene_.capabilities().unsymmetric_matrix,
                                      matrix_, discretization_.communicator());
  if (linear_->is_iterative())
    undeformed_ = collect_geometry(discretization_, supports_.homogeneous());
}

void TangentMatrix::follow_couplings() {
  bool is_known = linear_ != nullptr;
  for (const auto &contact : contacts_)
    is_known = is_known && !contact.with_matrix().couplings().has_new();
  if (!contacts_.of_bodies().empty() &&
      dealii::Utilities::MPI::min(is_known ? 1 : 0, discretization_.communicator()) == 0)
    build();
}

void TangentMatrix::follow_supports() {
  if (!linear_) // it is built once the contacts are known
    return;
  build(true);
  if (linear_->is_iterative())
    undeformed_ = collect_geometry(discretization_, supports_.homogeneous());
}

bool TangentMatrix::take_exact() {
  if (kind_ == ContactTangent::exact || contacts_.empty())
    return false;
  kind_ = ContactTangent::exact;
  for (auto &contact : contacts_)
    contact.with_matrix().set_tangent(kind_);
  if (linear_) { // else it is built once the contacts are known
    linear_->release();
    linear_.reset();
    build();
  }
  return true;
}

bool TangentMatrix::solve(const Vector &b, const double relative_tolerance, Vector &x) {
  if (!linear_->solve(b, x, relative_tolerance))
    return false;
  supports_.homogeneous().distribute(x);
  return true;
}

void TangentMatrix::set_geometry(const Vector &displacements) {
  if (!linear_->is_iterative())
    return;
  NodalGeometry geometry = undeformed_;
  const auto values = owned_values(displacements);
  for (std::size_t i = 0; i < geometry.positions.size(); ++i)
    geometry.positions[i] += values[i];
  linear_->set_geometry(geometry);
}

void TangentMatrix::start_contact() {
  if (!linear_->is_iterative() || contacts_.of_bodies().empty())
    return;
  matrix_.compress(dealii::VectorOperation::add);
  linear_->start_contact(touching_dofs());
}

std::vector<int> TangentMatrix::touching_dofs() const {
  Vector additive = discretization_.make_additive_vector(), forces = discretization_.make_owned_vector();
  for (const auto &contact : contacts_.of_bodies())
    contact.with_matrix().add_forces(additive);
  additive.compress(dealii::VectorOperation::add);
  forces = additive;
  Vector condensed(forces); // of nodes on which hanging nodes that touch depend, too
  supports_.condense(condensed);
  const auto values = owned_values(forces), of_masters = owned_values(condensed);
  const auto is_loaded = [](const auto &of, const std::size_t i) {
    return of[i] != 0. || of[i + 1] != 0. || of[i + 2] != 0.;
  };
  std::vector<int> dofs;
  for (std::size_t i = 0; i < values.size(); i += 3)
    if (is_loaded(values, i) || is_loaded(of_masters, i))
      for (std::size_t dof = i; dof < i + 3; ++dof)
        dofs.push_back(static_cast<int>(dof));
  return dofs;
}

} // namespace billet
