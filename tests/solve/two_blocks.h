// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SOLVE_TWO_BLOCKS_H
#define BILLET_TESTS_SOLVE_TWO_BLOCKS_H

#include "billet/algebra/iterative_solver.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>
#include <deal.II/lac/affine_constraints.h>

#include <cmath>
#include <map>
#include <memory>

namespace billet::testing {

/// Two elastic unit cubes with meshes that do not fit, one on the other, held at the bottom and sideways at
/// the top, and tied by node-to-facet penalties as contact makes them in one pass: one linear system, as in a
/// Newton step.
class TwoBlocks {
public:
  enum class Tie { frictionless, sliding, sticking };

  /// About so many dofs. `across`: each rank has a part of both cubes; else METIS parts them.
  TwoBlocks(MPI_Comm communicator, double n_dofs, bool across);

  /// The matrix: first that of the cubes alone, then that of the penalty k E/h [force/length³], too.
  void assemble_cubes();
  void add_contact(double k, Tie tie);

  MPI_Comm communicator() const { return communicator_; }
  dealii::types::global_dof_index n_dofs() const { return dof_handler_.n_dofs(); }
  const Matrix &matrix() const { return matrix_; }
  NodalGeometry geometry() const { return {positions_, constrained_}; }
  /// Owned dofs of the interface, by local number.
  const std::vector<int> &contact_dofs() const { return contact_dofs_; }
  unsigned int n_pairs() const {
    return dealii::Utilities::MPI::sum(static_cast<unsigned int>(pairs_.size()), communicator_);
  }
  /// Rough, with a push from above.
  Vector make_load() const;

private:
  using Dof = dealii::types::global_dof_index;
  struct Pair {
    std::array<Dof, 15> dofs; ///< of the slave node, then of the facet's four
    std::array<double, 5> weights;
  };
  static constexpr double young_ = 200e3, poisson_ = 0.3;
  static constexpr double gap_ = 1e-3; ///< so that the nodes of the interface stay two

  void make_mesh(bool across);
  void find_interface();
  void make_pattern();

  MPI_Comm communicator_;
  std::array<unsigned int, 2> sides_{}; ///< elements along an edge
  dealii::parallel::fullydistributed::Triangulation<3> mesh_;
  dealii::FESystem<3> fe_;
  dealii::DoFHandler<3> dof_handler_;
  dealii::IndexSet owned_, relevant_;
  dealii::AffineConstraints<double> constraints_;
  std::vector<double> positions_;
  std::vector<bool> constrained_;
  std::vector<int> contact_dofs_;
  std::vector<Pair> pairs_;
  Matrix matrix_;
};

inline TwoBlocks::TwoBlocks(MPI_Comm communicator, const double n_dofs, const bool across)
    : communicator_(communicator), mesh_(communicator), fe_(dealii::FE_Q<3>(1), 3) {
  // n³ + (8/7 n)³ elements.
  const double side = std::cbrt(n_dofs / 3. / 2.5) - 0.8;
  sides_[0] = std::max(1u, static_cast<unsigned int>(std::lround(side)));
  sides_[1] = sides_[0] + sides_[0] / 7 + 1;
  make_mesh(across);
  dof_handler_.reinit(mesh_);
  dof_handler_.distribute_dofs(fe_);
  owned_ = dof_handler_.locally_owned_dofs();
  relevant_ = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler_);
  find_interface();
  make_pattern();
}

inline void TwoBlocks::make_mesh(const bool across) {
  dealii::Triangulation<3> whole, cubes[2];
  for (unsigned int b = 0; b < 2; ++b) {
    const double z = b == 0 ? -1. : gap_;
    dealii::GridGenerator::subdivided_hyper_rectangle(cubes[b], {sides_[b], sides_[b], sides_[b]},
                                                      dealii::Point<3>(0, 0, z),
                                                      dealii::Point<3>(1, 1, z + 1.));
    for (const auto &cell : cubes[b].active_cell_iterators())
      cell->set_material_id(b);
  }
  dealii::GridGenerator::merge_triangulations(cubes[0], cubes[1], whole, 1e-6, true);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator_);
  if (across)
    for (const auto &cell : whole.active_cell_iterators())
      cell->set_subdomain_id(std::min(n_ranks - 1, static_cast<unsigned int>(cell->center()[0] * n_ranks)));
  else
    dealii::GridTools::partition_triangulation(n_ranks, whole, dealii::SparsityTools::Partitioner::metis);
  mesh_.create_triangulation(
      dealii::TriangulationDescription::Utilities::create_description_from_triangulation(whole,
                                                                                         communicator_));
}

inline void TwoBlocks::find_interface() {
  positions_.resize(owned_.n_elements());
  constrained_.resize(owned_.n_elements());
  constraints_.reinit(dealii::complete_index_set(dof_handler_.n_dofs()));    // pairs join dofs of other ranks
  std::array<std::map<std::pair<unsigned int, unsigned int>, Dof>, 2> grids; // of the interface
  std::vector<unsigned int> own_nodes;                                       // body, i, j, first dof
  for (const auto &cell : dof_handler_.active_cell_iterators())
    if (!cell->is_artificial())
      for (const unsigned int v : cell->vertex_indices()) {
        const dealii::Point<3> x = cell->vertex(v);
        const Dof dof = cell->vertex_dof_index(v, 0);
        const unsigned int body = cell->material_id();
        for (unsigned int i = 0; i < 3; ++i)
          if (std::abs(x[2] + 1.) < 1e-9 || (x[2] > 1. + 0.5 * gap_ && i < 2))
            constraints_.add_line(dof + i);
        if (!owned_.is_element(dof))
          continue;
        for (unsigned int i = 0; i < 3; ++i)
          positions_[owned_.index_within_set(dof + i)] = x[i];
        if (std::abs(x[2] - (body == 1 ? gap_ : 0.)) < 1e-9)
          for (const unsigned int value :
               {body, static_cast<unsigned int>(std::lround(x[0] * sides_[body])),
                static_cast<unsigned int>(std::lround(x[1] * sides_[body])), static_cast<unsigned int>(dof)})
            own_nodes.push_back(value);
      }
  constraints_.close();
  for (const auto &line : constraints_.get_lines())
    if (owned_.is_element(line.index))
      constrained_[owned_.index_within_set(line.index)] = true;
  for (const auto &part : dealii::Utilities::MPI::all_gather(communicator_, own_nodes))
    for (std::size_t k = 0; k < part.size(); k += 4)
      grids[part[k]][{part[k + 1], part[k + 2]}] = part[k + 3];
  for (const auto &grid : grids)
    for (const auto &node : grid)
      for (unsigned int i = 0; i < 3; ++i)
        if (owned_.is_element(node.second))
          contact_dofs_.push_back(static_cast<int>(owned_.index_within_set(node.second + i)));

  // One pass: each node of the upper cube on a facet of the lower. Its owner adds what they make.
  for (const auto &[place, slave] : grids[1]) {
    if (!owned_.is_element(slave))
      continue;
    const std::array<double, 2> x = {
        {1. * place.first / sides_[1] * sides_[0], 1. * place.second / sides_[1] * sides_[0]}};
    std::array<unsigned int, 2> facet{};
    for (unsigned int c = 0; c < 2; ++c)
      facet[c] = std::min(sides_[0] - 1, static_cast<unsigned int>(x[c]));
    const double s = x[0] - facet[0], t = x[1] - facet[1];
    const std::array<Dof, 5> nodes = {
        {slave, grids[0].at({facet[0], facet[1]}), grids[0].at({facet[0] + 1, facet[1]}),
         grids[0].at({facet[0], facet[1] + 1}), grids[0].at({facet[0] + 1, facet[1] + 1})}};
    Pair pair;
    pair.weights = {{1., -(1. - s) * (1. - t), -s * (1. - t), -(1. - s) * t, -s * t}};
    for (unsigned int i = 0; i < 15; ++i)
      pair.dofs[i] = nodes[i / 3] + i % 3;
    pairs_.push_back(pair);
  }
}

inline void TwoBlocks::make_pattern() {
  dealii::IndexSet writable = relevant_;
  for (const auto &pair : pairs_)
    for (const Dof dof : pair.dofs)
      writable.add_index(dof);
  SparsityPattern pattern(owned_, owned_, writable, communicator_);
  dealii::DoFTools::make_sparsity_pattern(dof_handler_, pattern, constraints_, false,
                                          dealii::Utilities::MPI::this_mpi_process(communicator_));
  for (const auto &pair : pairs_)
    constraints_.add_entries_local_to_global(std::vector<Dof>(pair.dofs.begin(), pair.dofs.end()), pattern,
                                             false);
  pattern.compress();
  matrix_.reinit(pattern);
}

inline void TwoBlocks::assemble_cubes() {
  const dealii::QGauss<3> quadrature(2);
  dealii::FEValues<3> values(fe_, quadrature, dealii::update_gradients | dealii::update_JxW_values);
  dealii::FullMatrix<double> local(24, 24);
  std::vector<Dof> dofs(24);
  const double mu = young_ / 2. / (1. + poisson_);
  const double lambda = young_ * poisson_ / (1. + poisson_) / (1. - 2. * poisson_);
  matrix_ = 0.;
  for (const auto &cell : dof_handler_.active_cell_iterators()) {
    if (!cell->is_locally_owned())
      continue;
    values.reinit(cell);
    local = 0.;
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      for (unsigned int i = 0; i < 24; ++i)
        for (unsigned int j = 0; j < 24; ++j) {
          const unsigned int ci = i % 3, cj = j % 3;
          const auto &gi = values.shape_grad(i, q), &gj = values.shape_grad(j, q);
          local(i, j) +=
              (lambda * gi[ci] * gj[cj] + mu * gi[cj] * gj[ci] + (ci == cj ? mu * (gi * gj) : 0.)) *
              values.JxW(q);
        }
    cell->get_dof_indices(dofs);
    constraints_.distribute_local_to_global(local, dofs, matrix_);
  }
  matrix_.compress(dealii::VectorOperation::add);
}

inline void TwoBlocks::add_contact(const double k, const Tie tie) {
  constexpr double friction = 0.3;
  const double stiffness = k * young_ * sides_[0] / sides_[1] / sides_[1]; // of a node
  dealii::FullMatrix<double> local(15, 15);
  for (const auto &pair : pairs_) {
    for (unsigned int i = 0; i < 15; ++i)
      for (unsigned int j = 0; j < 15; ++j) {
        const unsigned int ci = i % 3, cj = j % 3;
        // Sliding along x: the friction is that part of the pressure.
        const double factor = ci == 2 && cj == 2                          ? 1.
                              : tie == Tie::sticking && ci == cj          ? 1.
                              : tie == Tie::sliding && ci == 0 && cj == 2 ? friction
                                                                          : 0.;
        local(i, j) = factor * stiffness * pair.weights[i / 3] * pair.weights[j / 3];
      }
    constraints_.distribute_local_to_global(local, std::vector<Dof>(pair.dofs.begin(), pair.dofs.end()),
                                            matrix_);
  }
  matrix_.compress(dealii::VectorOperation::add);
}

inline Vector TwoBlocks::make_load() const {
  Vector load(owned_, communicator_);
  for (std::size_t i = 0; i < positions_.size(); ++i)
    if (!constrained_[i]) {
      const std::size_t node = i - i % 3;
      const double rough = std::sin(1000. * (0.78233 * positions_[node] + 0.37719 * positions_[node + 1] +
                                             0.129898 * positions_[node + 2]) +
                                    static_cast<double>(i % 3));
      load(owned_.nth_index_in_set(i)) = rough - (i % 3 == 2 && positions_[node + 2] > 1. ? 10. : 0.);
    }
  load.compress(dealii::VectorOperation::insert);
  return load;
}

} // namespace billet::testing

#endif
