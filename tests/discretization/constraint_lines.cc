// SPDX-License-Identifier: LGPL-2.1-or-later
// Constraints from two sources, hanging nodes and a plane that holds nodes, on a mesh that is refined beside
// the plane: a linear field passes, hanging nodes count first, and condensing forces is the transpose of
// distributing displacements, on any number of ranks.
#include "billet/discretization/constraint_lines.h"
#include "billet/discretization/hanging_nodes.h"
#include "billet/errors.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

#include <map>

namespace constraint_lines_test {

using billet::DofIndex;
using billet::Vector;

namespace {

/// A cube whose corner is refined twice, partitioned.
void make_mesh(dealii::parallel::fullydistributed::Triangulation<3> &mesh) {
  dealii::Triangulation<3> whole(dealii::Triangulation<3>::limit_level_difference_at_vertices);
  dealii::GridGenerator::subdivided_hyper_cube(whole, 3);
  for (unsigned int level = 0; level < 2; ++level) {
    for (const auto &cell : whole.active_cell_iterators())
      if (cell->center().norm() < 0.5)
        cell->set_refine_flag();
    whole.execute_coarsening_and_refinement();
  }
  const MPI_Comm communicator = mesh.get_communicator();
  dealii::GridTools::partition_triangulation(dealii::Utilities::MPI::n_mpi_processes(communicator), whole);
  mesh.create_triangulation(
      dealii::TriangulationDescription::Utilities::create_description_from_triangulation(
          whole, communicator, dealii::TriangulationDescription::Settings::default_setting));
}

/// A linear displacement of a point.
dealii::Tensor<1, 3> field(const dealii::Point<3> &x) {
  return dealii::Tensor<1, 3>({0.3 + x[0] - 2. * x[1], 0.5 * x[2] - x[0], 1. + x[0] + 2. * x[1] + 3. * x[2]});
}

/// Whether this rank learns that a method does not support hanging nodes.
bool is_refused(const dealii::DoFHandler<3> &dof_handler) {
  try {
    billet::require_no_hanging_nodes(dof_handler, "This method");
  } catch (const billet::InputError &error) {
    return std::string(error.what()).find("This method") != std::string::npos;
  }
  return false;
}

/// Whether a cube refined as a whole is refused.
bool refuses_uniform_mesh(const MPI_Comm communicator) {
  dealii::Triangulation<3> whole(dealii::Triangulation<3>::limit_level_difference_at_vertices);
  dealii::GridGenerator::subdivided_hyper_cube(whole, 2);
  whole.refine_global(1);
  dealii::GridTools::partition_triangulation(dealii::Utilities::MPI::n_mpi_processes(communicator), whole);
  dealii::parallel::fullydistributed::Triangulation<3> mesh(communicator);
  mesh.create_triangulation(
      dealii::TriangulationDescription::Utilities::create_description_from_triangulation(
          whole, communicator, dealii::TriangulationDescription::Settings::default_setting));
  dealii::DoFHandler<3> dof_handler(mesh);
  const dealii::FE_Q<3> element(1);
  dof_handler.distribute_dofs(element);
  return is_refused(dof_handler);
}

double sum(const Vector &vector, const MPI_Comm communicator) {
  double local = 0.;
  for (const DofIndex dof : vector.locally_owned_elements())
    local += vector(dof);
  return dealii::Utilities::MPI::sum(local, communicator);
}

} // namespace

BILLET_MPI_TEST(constraint_lines) {
  const MPI_Comm communicator = MPI_COMM_WORLD;
  dealii::parallel::fullydistributed::Triangulation<3> mesh(communicator);
  make_mesh(mesh);
  dealii::DoFHandler<3> dof_handler(mesh);
  const dealii::FESystem<3> element(dealii::FE_Q<3>(1), 3);
  dof_handler.distribute_dofs(element);
  const dealii::IndexSet owned = dof_handler.locally_owned_dofs();
  const dealii::IndexSet relevant = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);

  std::map<DofIndex, double> exact; // of relevant dofs
  std::map<DofIndex, std::array<DofIndex, 3>> held;
  std::map<DofIndex, dealii::Point<3>> positions;
  const dealii::Tensor<1, 3> normal({0.6, 0.8, 0.});
  for (const auto &cell : dof_handler.active_cell_iterators()) {
    if (cell->is_artificial())
      continue;
    for (const unsigned int v : cell->vertex_indices()) {
      std::array<DofIndex, 3> dofs{};
      for (unsigned int i = 0; i < 3; ++i) {
        dofs[i] = cell->vertex_dof_index(v, i);
        exact[dofs[i]] = field(cell->vertex(v))[i];
      }
      if (cell->vertex(v)[0] < 1e-10) { // a plane whose nodes move along an inclined one
        held[dofs[0]] = dofs;
        positions[dofs[0]] = cell->vertex(v);
      }
    }
  }

  const std::vector<billet::ConstraintLine> hanging = billet::collect_hanging_nodes(dof_handler, relevant);
  std::vector<billet::ConstraintLine> lines;
  std::vector<double> values;
  for (const auto &[first, dofs] : held) {
    lines.push_back({dofs[1], {{dofs[0], -normal[0] / normal[1]}}}); // n · u as the field has it
    values.push_back(normal * field(positions.at(first)) / normal[1]);
  }
  const auto constraints = billet::build_constraints(owned, relevant, {{hanging, {}}, {lines, values}});
  const auto homogeneous = billet::build_constraints(owned, relevant, {{hanging, {}}, {lines, {}}});

  std::size_t n_both = 0, n_foreign = 0;
  bool hanging_count_first = true;
  for (const auto &line : hanging) {
    for (const auto &entry : line.others)
      n_foreign += owned.is_element(line.dof) && !owned.is_element(entry.first) ? 1 : 0;
    for (const auto &other : lines)
      if (other.dof == line.dof) {
        ++n_both;
        hanging_count_first = hanging_count_first && constraints.get_constraint_entries(line.dof)->size() > 1;
      }
  }
  const auto all = [&](const bool holds) {
    return dealii::Utilities::MPI::min(holds ? 1 : 0, communicator) == 1;
  };
  n_both = dealii::Utilities::MPI::sum(n_both, communicator);
  n_foreign = dealii::Utilities::MPI::sum(n_foreign, communicator);
  hanging_count_first = all(hanging_count_first);
  const bool couples = billet::couple_ranks(homogeneous, owned, communicator);

  Vector u(owned, communicator);
  for (const DofIndex dof : owned)
    u(dof) = constraints.is_constrained(dof) ? 1e3 : exact.at(dof);
  u.compress(dealii::VectorOperation::insert);
  constraints.distribute(u);
  double error = 0.;
  for (const DofIndex dof : owned)
    error = std::max(error, std::abs(u(dof) - exact.at(dof)));
  error = dealii::Utilities::MPI::max(error, communicator);

  // v · Cᵀf = C v · f
  billet::testing::Random random;
  std::map<DofIndex, double> numbers;
  for (DofIndex dof = 0; dof < dof_handler.n_dofs(); ++dof)
    numbers[dof] = random(-1., 1.);
  Vector v(owned, communicator), f(owned, communicator), product(owned, communicator);
  for (const DofIndex dof : owned) {
    v(dof) = numbers.at(dof);
    f(dof) = numbers.at(dof_handler.n_dofs() - 1 - dof);
  }
  v.compress(dealii::VectorOperation::insert);
  f.compress(dealii::VectorOperation::insert);
  Vector moved(v), condensed(f);
  homogeneous.distribute(moved);
  billet::condense(homogeneous, couples, condensed);
  double left_on_constrained = 0.;
  for (const DofIndex dof : owned)
    if (homogeneous.is_constrained(dof))
      left_on_constrained = std::max(left_on_constrained, std::abs(condensed(dof)));
  const double by_forces = v * condensed, by_motion = moved * f;

  // A rigid translation of unconstrained hanging nodes keeps the sum of the forces.
  const auto only_hanging = billet::build_constraints(owned, relevant, {{hanging, {}}});
  Vector balanced(f);
  billet::condense(only_hanging, billet::couple_ranks(only_hanging, owned, communicator), balanced);
  const double change = std::abs(sum(balanced, communicator) - sum(f, communicator));

  const bool refused = all(is_refused(dof_handler)),
             refused_in_error = !all(!refuses_uniform_mesh(communicator));

  left_on_constrained = dealii::Utilities::MPI::max(left_on_constrained, communicator);
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0) {
    using billet::testing::check;
    const bool is_parallel = dealii::Utilities::MPI::n_mpi_processes(communicator) > 1;
    check("Some hanging nodes are held as well", n_both > 0);
    check("Hanging nodes count first", hanging_count_first);
    check("Constraints couple ranks as hanging nodes do",
          couples == (n_foreign > 0) && couples == is_parallel);
    check("A linear field", error, 1e-13);
    check("Condensing is the transpose of distributing",
          std::abs(by_forces - by_motion) / std::abs(by_motion), 1e-12);
    check("No force is left on constrained dofs", left_on_constrained, 0.);
    check("Hanging nodes keep the sum of forces", change, 1e-12);
    check("All ranks learn that a method does not support hanging nodes", refused);
    check("A mesh refined as a whole has none", !refused_in_error);
  }
}

} // namespace constraint_lines_test
