// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/mesh_errors.h"

#include "billet/discretization/element_key.h"
#include "billet/discretization/node_keys.h"
#include "billet/discretization/smooth_facets.h"
#include "billet/discretization/supports.h"
#include "billet/solve/refined_reader.h"
#include "billet/solve/restart.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace billet {

using dealii::Point;
using dealii::Tensor;

namespace {

constexpr unsigned int n_stresses = 6;
constexpr std::size_t row_width = 2 * n_stresses + n_element_dofs + 1;

/// Factors of (W4).
struct MeshErrorFactors {
  /// Part of J² h A over the secant modulus of the interval: what half as long elements save in an
  /// elastic bar. Of rigid plasticity it is twice as much as they save, on the safe side.
  static constexpr double of_jump = 1. / 12.;
  /// Part of the normal jump that counts.
  static constexpr double normal = 0.5;
  /// Part of a face's jump with which an element is charged; its neighbour is charged with the
  /// other half.
  static constexpr double own = 0.5;
  /// Part of the squared strain that may vary unseen, (W9).
  static constexpr double unseen = 0.1;
};

Tensor<1, 3> node_of(const ElementVectors &vectors, const unsigned int a) {
  return Tensor<1, 3>({vectors[3 * a], vectors[3 * a + 1], vectors[3 * a + 2]});
}

/// Returns the gradient of an element's nodal vectors at a point in its coordinates from −1 to 1.
/// Also returns 8 times the Jacobian there, which at the centre is its volume.
std::pair<Tensor<2, 3>, double> gradient_at(const Tensor<1, 3> &place, const ElementVectors &positions,
                                            const ElementVectors &values) {
  Tensor<2, 3> jacobian, derivatives; // ∂x_i/∂ξ_j, ∂v_i/∂ξ_j
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int j = 0; j < 3; ++j) {
      double derivative = ((a >> j) & 1U) == 1U ? 0.125 : -0.125;
      for (unsigned int k = 0; k < 3; ++k)
        if (k != j)
          derivative *= 1. + (((a >> k) & 1U) == 1U ? place[k] : -place[k]);
      for (unsigned int i = 0; i < 3; ++i) {
        jacobian[i][j] += derivative * positions[3 * a + i];
        derivatives[i][j] += derivative * values[3 * a + i];
      }
    }
  const double determinant = dealii::determinant(jacobian);
  if (!(determinant > 0.))
    return {Tensor<2, 3>(), 0.};
  return {derivatives * dealii::invert(jacobian), 8. * determinant};
}

/// Returns the positions of an element's nodes in the middle between two displacements.
ElementVectors middle_of(ElementVectors positions, const ElementVectors &before, const ElementVectors &now) {
  for (unsigned int i = 0; i < n_element_dofs; ++i)
    positions[i] += 0.5 * (before[i] + now[i]);
  return positions;
}

double equivalent_of(const dealii::SymmetricTensor<2, 3> &tensor) { return dealii::deviator(tensor).norm(); }

/// Returns works of bodies over that of all; zeros if there is none.
std::vector<double> over(std::vector<double> works, const double all) {
  for (double &work : works)
    work = all > 0. ? work / all : 0.;
  return works;
}

double sum_of(const std::vector<double> &parts) { return std::accumulate(parts.begin(), parts.end(), 0.); }

} // namespace

MeshErrors::MeshErrors(const Scene &scene, const Discretization &discretization)
    : discretization_(discretization), errors_(discretization.n_bodies()),
      work_outside_(discretization.n_bodies()) {
  const std::set<DofIndex> fixed_nodes = collect_fixed_nodes(scene, discretization);
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body) {
    elements_.emplace_back(discretization.elements(body).size());
    for (std::size_t e = 0; e < elements_[body].size(); ++e) {
      const Element &element = discretization.elements(body)[e];
      const CellIterator &cell = element.cell;
      volume_ += cell->measure();
      elements_[body][e].is_fixed = true;
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        if (fixed_nodes.count(element.dofs[3 * a]) == 0)
          elements_[body][e].is_fixed = false;
    }
  }
  volume_ = dealii::Utilities::MPI::sum(volume_, discretization.communicator());
  find_unseen(scene);
  measure_facets();
}

void MeshErrors::find_unseen(const Scene &scene) {
  const double tolerance = Constraint::rounding * discretization_.radius();
  for (std::size_t body = 0; body < elements_.size(); ++body) {
    const auto &constraints = scene.bodies()[body].constraints;
    // A side in a symmetry plane has a mirror image beyond it.
    const auto is_free = [&](const CellIterator &cell, const unsigned int f) {
      return cell->face(f)->at_boundary() &&
             std::none_of(constraints.begin(), constraints.end(), [&](const Constraint &constraint) {
               return constraint.on_plane && constrains_face(constraint, cell->face(f), tolerance);
             });
    };
    // Whether a free face is across the neighbour at a face.
    const auto ends_beyond = [&](const CellIterator &cell, const unsigned int f) {
      if (cell->face(f)->at_boundary() || cell->neighbor(f)->has_children())
        return false;
      const unsigned int of_neighbour = cell->neighbor_of_neighbor(f);
      return is_free(cell->neighbor(f), dealii::GeometryInfo<3>::opposite_face[of_neighbour]);
    };
    for (std::size_t e = 0; e < elements_[body].size(); ++e) {
      const CellIterator &cell = discretization_.elements(body)[e].cell;
      std::array<bool, 3> is_pair{};
      for (unsigned int d = 0; d < 3; ++d)
        is_pair[d] = (is_free(cell, 2 * d) && ends_beyond(cell, 2 * d + 1)) ||
                     (is_free(cell, 2 * d + 1) && ends_beyond(cell, 2 * d));
      const bool is_bar = std::count(is_pair.begin(), is_pair.end(), true) > 1;
      for (unsigned int d = 0; d < 3; ++d)
        elements_[body][e].is_unseen[d] =
            (cell->face(2 * d)->at_boundary() && cell->face(2 * d + 1)->at_boundary()) ||
            (is_bar && is_pair[d]);
    }
  }
}

void MeshErrors::measure_facets() {
  for (std::size_t body = 0; body < elements_.size(); ++body) {
    const std::vector<BoundaryFacet> facets = collect_boundary_facets(discretization_, body);
    const std::vector<SmoothFacet> smooth = make_smooth_facets(discretization_, facets);
    std::map<std::uint64_t, double> outside; // by element
    for (std::size_t f = 0; f < facets.size(); ++f)
      outside[facets[f].key / dealii::GeometryInfo<3>::faces_per_cell] +=
          mean_distance(smooth[f].bulge) / facets[f].thickness;
    for (std::size_t e = 0; e < elements_[body].size(); ++e)
      if (const auto found = outside.find(element_key(discretization_.elements(body)[e].cell));
          found != outside.end())
        elements_[body][e].outside = found->second;
  }
}

MeshErrors::Interval MeshErrors::compare(const ElementVectors &positions, const OwnedElement &element,
                                         const ElementVectors &displacements) const {
  ElementVectors increment = displacements;
  for (unsigned int i = 0; i < n_element_dofs; ++i)
    increment[i] -= element.displacements[i];
  const ElementVectors middle = middle_of(positions, element.displacements, displacements);
  const auto [gradient, volume] = gradient_at({}, middle, increment);
  const Stress strain = dealii::symmetrize(gradient);
  Interval interval;
  interval.stress = element.stress_sum / static_cast<double>(n_states_);
  interval.volume = volume;
  interval.strain = std::sqrt(2. / 3.) * equivalent_of(strain);
  interval.work = volume * (interval.stress * strain);
  for (unsigned int d = 0; d < 3; ++d)
    if (element.is_unseen[d]) {
      Tensor<1, 3> face;
      face[d] = 1.;
      const Stress change = dealii::symmetrize(gradient_at(face, middle, increment).first -
                                               gradient_at(-face, middle, increment).first);
      interval.unseen += volume * 0.25 * (change * change) / 3.; // of ± half of it, linearly
    }
  interval.squared_strain = volume * (strain * strain) + interval.unseen;
  if (element.is_fixed) // its strain is given, and does not depend on balance
    interval.unseen = interval.squared_strain;
  return interval;
}

std::vector<MeshErrors::Interval> MeshErrors::compare_all(const Solution &solution) {
  const auto &dof_handler = discretization_.dof_handler();
  std::vector<Interval> intervals(dof_handler.get_triangulation().n_active_cells());
  const SolutionState &state = solution.state();
  for (std::size_t body = 0; body < elements_.size(); ++body)
    for (std::size_t e = 0; e < elements_[body].size(); ++e) {
      const Element &element = discretization_.elements(body)[e];
      intervals[element.cell->active_cell_index()] = compare(
          nodal_positions(element.cell), elements_[body][e], gather(state.displacements, element.dofs));
    }
  using Shown = std::array<double, n_stresses + 1>;
  dealii::GridTools::exchange_cell_data_to_ghosts<Shown, dealii::DoFHandler<3>>(
      dof_handler,
      [&](const CellIterator &cell) {
        const Interval &own = intervals[cell->active_cell_index()];
        Shown shown{};
        for (unsigned int c = 0; c < n_stresses; ++c)
          shown[c] = own.stress.access_raw_entry(c);
        shown[n_stresses] = own.volume;
        return shown;
      },
      [&](const CellIterator &cell, const Shown &shown) {
        Interval &other = intervals[cell->active_cell_index()];
        for (unsigned int c = 0; c < n_stresses; ++c)
          other.stress.access_raw_entry(c) = shown[c];
        other.volume = shown[n_stresses];
      });
  return intervals;
}

double MeshErrors::saved_work(const CellIterator &cell, const ElementVectors &positions,
                              const std::vector<Interval> &intervals) {
  const Interval &own = intervals[cell->active_cell_index()];
  const double equivalent = std::sqrt(1.5) * equivalent_of(own.stress);
  double saved = 0.;
  for (const unsigned int f : cell->face_indices()) {
    if (cell->face(f)->at_boundary())
      continue;
    const Interval &other = intervals[cell->neighbor(f)->active_cell_index()];
    std::array<Tensor<1, 3>, 4> x;
    for (unsigned int v = 0; v < 4; ++v)
      x[v] = node_of(positions, dealii::GeometryInfo<3>::face_to_cell_vertices(f, v));
    const Tensor<1, 3> area = 0.5 * dealii::cross_product_3d(x[3] - x[0], x[2] - x[1]);
    const double size = area.norm();
    if (!(size > 0.))
      continue; // on an axis
    const Tensor<1, 3> normal = area / size, jump = (own.stress - other.stress) * normal;
    const double across = jump * normal, along = std::max(0., jump.norm_square() - across * across);
    const double height = 0.5 * (own.volume + other.volume) / size;
    // A jump above the stress itself does not make the element softer than the strain that it has.
    const double modulus = std::max(equivalent, jump.norm()) / 3.;
    if (modulus > 0.)
      saved += MeshErrorFactors::own * MeshErrorFactors::of_jump * height * size *
               (along + MeshErrorFactors::normal * across * across) * own.strain / modulus;
  }
  return saved;
}

void MeshErrors::add(const Solution &solution, const bool ends_interval) {
  for (std::size_t body = 0; body < elements_.size(); ++body) {
    const std::vector<ElementSummary> summaries = solution.summarize(body);
    for (std::size_t e = 0; e < elements_[body].size(); ++e) {
      OwnedElement &own = elements_[body][e];
      const Stress stress = summaries[e].cauchy_stress;
      if (has_begun_)
        own.stress_sum += 0.5 * (own.stress + stress);
      else
        own.displacements = gather(solution.state().displacements, discretization_.elements(body)[e].dofs);
      own.stress = stress;
    }
  }
  if (has_begun_) {
    ++n_states_;
    if (ends_interval)
      add_interval(solution);
  }
  has_begun_ = true;
}

void MeshErrors::add_interval(const Solution &solution) {
  const std::vector<Interval> intervals = compare_all(solution);
  // By body, the work that finer elements save and that outside; the work of elements, and squared
  // strains.
  std::vector<double> sums(2 * elements_.size() + 3);
  for (std::size_t body = 0; body < elements_.size(); ++body)
    for (std::size_t e = 0; e < elements_[body].size(); ++e) {
      const Element &element = discretization_.elements(body)[e];
      OwnedElement &own = elements_[body][e];
      const ElementVectors displacements = gather(solution.state().displacements, element.dofs);
      const double saved =
          saved_work(element.cell, middle_of(nodal_positions(element.cell), own.displacements, displacements),
                     intervals);
      own.error += saved;
      sums[body] += saved;
      const Interval &interval = intervals[element.cell->active_cell_index()];
      sums[elements_.size() + body] += own.outside * std::abs(interval.work);
      double *const of_all = &sums[2 * elements_.size()];
      of_all[0] += std::abs(interval.work);
      of_all[1] += interval.squared_strain;
      of_all[2] += interval.unseen;
      own.stress_sum = 0.;
      own.displacements = displacements;
    }
  n_states_ = 0;
  dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
  for (std::size_t body = 0; body < elements_.size(); ++body) {
    errors_[body] += sums[body];
    work_outside_[body] += sums[elements_.size() + body];
  }
  const double *const of_all = &sums[2 * elements_.size()];
  work_ += of_all[0];
  squared_strain_ += of_all[1];
  unseen_ += of_all[2];
}

double MeshErrors::error() const { return sum_of(of_bodies()); }

std::vector<double> MeshErrors::of_bodies() const { return over(errors_, work_); }

bool MeshErrors::sees_variation() const { return unseen_ <= MeshErrorFactors::unseen * squared_strain_; }

double MeshErrors::geometry_error() const { return sum_of(geometry_of_bodies()); }

std::vector<double> MeshErrors::geometry_of_bodies() const { return over(work_outside_, work_); }

double MeshErrors::of_element(const std::size_t body, const std::size_t element) const {
  if (!is_known())
    return 0.;
  return elements_[body][element].error / discretization_.elements(body)[element].cell->measure() /
         (work_ / volume_);
}

void MeshErrors::save(StateWriter &writer) const {
  std::vector<std::uint64_t> keys;
  std::vector<double> rows;
  RowWriter row(rows);
  for (std::size_t body = 0; body < elements_.size(); ++body)
    for (std::size_t e = 0; e < elements_[body].size(); ++e) {
      const OwnedElement &own = elements_[body][e];
      keys.push_back(element_key(discretization_.elements(body)[e].cell));
      for (unsigned int c = 0; c < n_stresses; ++c)
        row.number(own.stress.access_raw_entry(c));
      for (unsigned int c = 0; c < n_stresses; ++c)
        row.number(own.stress_sum.access_raw_entry(c));
      rows.insert(rows.end(), own.displacements.begin(), own.displacements.end());
      row.number(own.error);
    }
  std::vector<double> sums = errors_;
  sums.insert(sums.end(), work_outside_.begin(), work_outside_.end());
  sums.push_back(work_);
  sums.push_back(squared_strain_);
  sums.push_back(unseen_);
  sums.push_back(n_states_);
  sums.push_back(has_begun_ ? 1. : 0.);
  writer.write("mesh errors of intervals", sums);
  writer.write_rows("mesh errors of elements", row_width, keys, rows);
}

void MeshErrors::load(const StateReader &reader) {
  if (!reader.has("mesh errors of intervals"))
    return; // of an earlier version: the estimate begins here
  const std::vector<double> sums = reader.read("mesh errors of intervals", 2 * errors_.size() + 5);
  RowReader of_all(sums);
  for (double &error : errors_)
    error = of_all.number();
  for (double &work : work_outside_)
    work = of_all.number();
  for (double *number : {&work_, &squared_strain_, &unseen_})
    *number = of_all.number();
  n_states_ = to_count(of_all.number());
  has_begun_ = of_all.flag();
  std::vector<std::uint64_t> keys;
  for (std::size_t body = 0; body < elements_.size(); ++body)
    for (const Element &element : discretization_.elements(body))
      keys.push_back(element_key(element.cell));
  const std::vector<double> rows = reader.read_rows("mesh errors of elements", row_width, keys);
  RowReader row(rows);
  for (auto &of_body : elements_)
    for (OwnedElement &own : of_body) {
      for (unsigned int c = 0; c < n_stresses; ++c)
        own.stress.access_raw_entry(c) = row.number();
      for (unsigned int c = 0; c < n_stresses; ++c)
        own.stress_sum.access_raw_entry(c) = row.number();
      for (double &displacement : own.displacements)
        displacement = row.number();
      own.error = row.number();
    }
  const std::vector<bool> are_refined = refined_bodies(reader);
  for (std::size_t body = 0; body < are_refined.size(); ++body)
    for (std::size_t e = 0; are_refined[body] && e < elements_[body].size(); ++e)
      elements_[body][e] =
          part_of(elements_[body][e], child_number(element_key(discretization_.elements(body)[e].cell)));
}

MeshErrors::OwnedElement MeshErrors::part_of(const OwnedElement &element, const unsigned int child) {
  OwnedElement part = element;
  part.error /= n_element_nodes;
  for (unsigned int v = 0; v < n_element_nodes; ++v) {
    const auto weights = weights_in_parent(child, v);
    for (unsigned int i = 0; i < 3; ++i) {
      double &displacement = part.displacements[3 * v + i] = 0.;
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        displacement += weights[a] * element.displacements[3 * a + i];
    }
  }
  return part;
}

} // namespace billet
