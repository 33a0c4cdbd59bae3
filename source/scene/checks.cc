// SPDX-License-Identifier: LGPL-2.1-or-later
// What can only be checked once there is a mesh.
#include "billet/errors.h"
#include "billet/geometry/frame.h"
#include "billet/scene/scene.h"

#include <deal.II/base/bounding_box.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

namespace billet {

using dealii::Tensor;
using dealii::Triangulation;

bool holds_face(const Hold &hold, const Triangulation<3>::active_face_iterator &face,
                const double tolerance) {
  if (!hold.on_plane)
    return std::find(hold.boundary_ids.begin(), hold.boundary_ids.end(), face->boundary_id()) !=
           hold.boundary_ids.end();
  const auto vertices = face->vertex_indices();
  return std::all_of(vertices.begin(), vertices.end(), [&](const unsigned int v) {
    return std::abs(face->vertex(v) * hold.normal - hold.offset) <= tolerance;
  });
}

namespace {

std::string print(const Tensor<1, 3> &x) {
  std::ostringstream stream;
  stream << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return stream.str();
}

template <class Function> void for_each_boundary_face(const Triangulation<3> &mesh, const Function &f) {
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int i : cell->face_indices())
      if (cell->face(i)->at_boundary())
        f(static_cast<std::size_t>(cell->material_id()), cell->face(i));
}

void check_ids(const Located<std::vector<unsigned int>> &asked, const std::set<unsigned int> &present,
               const std::string &body) {
  for (const unsigned int id : asked.value)
    if (present.count(id) == 0) {
      std::string allowed;
      for (const unsigned int p : present)
        allowed += (allowed.empty() ? "" : ", ") + std::to_string(p);
      throw InputError(asked.origin + ": found boundary id " + std::to_string(id) +
                       ", allowed are those of body '" + body + "': " + allowed);
    }
}

/// Sum of r rᵀ over constraint rows r = (n, (x − c) × n / L) on the six rigid motions (translation, rotation
/// · L).
struct RigidMotionGram {
  std::array<std::array<double, 6>, 6> values{};
  void add(const Tensor<1, 3> &n, const Tensor<1, 3> &arm) {
    const Tensor<1, 3> m = dealii::cross_product_3d(arm, n);
    const std::array<double, 6> row{n[0], n[1], n[2], m[0], m[1], m[2]};
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        values[i][j] += row[i] * row[j];
  }
  /// Rigid motions that no row resists.
  std::vector<std::array<double, 6>> free_motions() const {
    dealii::LAPACKFullMatrix<double> matrix(6, 6);
    double trace = 0.;
    for (unsigned int i = 0; i < 6; ++i) {
      trace += values[i][i];
      for (unsigned int j = 0; j < 6; ++j)
        matrix(i, j) = values[i][j];
    }
    std::vector<std::array<double, 6>> result;
    dealii::Vector<double> eigenvalues(6);
    dealii::FullMatrix<double> vectors(6, 6);
    matrix.compute_eigenvalues_symmetric(-std::numeric_limits<double>::max(),
                                         std::numeric_limits<double>::max(), 0., eigenvalues, vectors);
    for (unsigned int k = 0; k < eigenvalues.size(); ++k)
      if (eigenvalues[k] <= 1e-10 * trace || trace == 0.) {
        result.emplace_back();
        for (unsigned int i = 0; i < 6; ++i)
          result.back()[i] = std::abs(vectors(i, k)) < 1e-8 ? 0. : vectors(i, k);
      }
    return result;
  }
};

/// Rows that resist a motion one way only: contact pushes, but does not pull.
class OneSidedRows {
public:
  /// `free`: the motions that are not held both ways.
  explicit OneSidedRows(std::vector<std::array<double, 6>> free) : free_(std::move(free)) {}

  void add(const Tensor<1, 3> &n, const Tensor<1, 3> &arm) {
    const Tensor<1, 3> m = dealii::cross_product_3d(arm, n);
    const std::array<double, 6> row{n[0], n[1], n[2], m[0], m[1], m[2]};
    std::vector<double> part(free_.size(), 0.);
    for (std::size_t k = 0; k < free_.size(); ++k)
      for (unsigned int i = 0; i < 6; ++i)
        part[k] += row[i] * free_[k][i];
    rows_.push_back(part);
  }

  /// A motion that no row resists, if there is one. All motions are held if the rows r_i span the space with
  /// factors λ_i >= 0, that is, if minus their sum is among Σ λ_i r_i; else what is left over is such a
  /// motion (Farkas). Found by coordinate descent.
  std::vector<std::array<double, 6>> free_motions() const {
    const std::size_t n = free_.size();
    if (n == 0)
      return {};
    std::vector<double> rest(n, 0.);
    double size = 0.;
    for (const auto &row : rows_)
      for (std::size_t k = 0; k < n; ++k) {
        rest[k] += row[k];
        size += row[k] * row[k];
      }
    // Motions across all rows are free whatever their signs.
    for (std::size_t k = 0; k < n; ++k) {
      double held = 0.;
      for (const auto &row : rows_)
        held += row[k] * row[k];
      if (held <= 1e-12 * (1. + size))
        return {free_[k]};
    }
    const double whole = std::sqrt(std::inner_product(rest.begin(), rest.end(), rest.begin(), 0.));
    std::vector<double> factors(rows_.size(), 0.);
    for (unsigned int sweep = 0; sweep < 1000; ++sweep)
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const auto &row = rows_[i];
        const double square = std::inner_product(row.begin(), row.end(), row.begin(), 0.);
        if (square <= 0.)
          continue;
        const double along = std::inner_product(row.begin(), row.end(), rest.begin(), 0.) / square;
        const double change = std::max(-factors[i], -along);
        factors[i] += change;
        for (std::size_t k = 0; k < n; ++k)
          rest[k] += change * row[k];
      }
    const double left = std::sqrt(std::inner_product(rest.begin(), rest.end(), rest.begin(), 0.));
    if (left <= 1e-2 * whole || left <= 1e-6 * std::sqrt(size))
      return {};
    std::array<double, 6> motion{};
    for (std::size_t k = 0; k < n; ++k)
      for (unsigned int i = 0; i < 6; ++i)
        motion[i] += rest[k] / left * free_[k][i];
    for (double &component : motion)
      component = std::abs(component) < 1e-2 ? 0. : component;
    return {motion};
  }

private:
  std::vector<std::array<double, 6>> free_;
  std::vector<std::vector<double>> rows_;
};

} // namespace

void Scene::check_boundary_ids(const Triangulation<3> &mesh, const MeshDetail detail) const {
  std::vector<std::set<unsigned int>> present(bodies_.size());
  for_each_boundary_face(
      mesh, [&](const std::size_t body, const auto &face) { present[body].insert(face->boundary_id()); });
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    // An outline may not show every face that a condition on the full mesh will catch.
    if (detail == MeshDetail::outline)
      for (const auto &renamed : parameters_.bodies[i].mesh.boundary_ids.value)
        present[i].insert(renamed.first);
    for (const auto &support : parameters_.bodies[i].supports)
      check_ids(support.boundary_ids, present[i], bodies_[i].name);
    for (const auto &load : parameters_.bodies[i].loads)
      check_ids(load.boundary_ids, present[i], bodies_[i].name);
  }
  for (const auto &pair : parameters_.pairs) {
    const std::size_t body = parameters_.body_index(pair);
    check_ids(pair.boundary_ids, present[body], bodies_[body].name);
    if (!pair.is_between_bodies())
      continue;
    const std::size_t second = parameters_.second_body_index(pair);
    check_ids(pair.second_boundary_ids, present[second], bodies_[second].name);
  }
}

void Scene::check_supports(const Triangulation<3> &mesh) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    std::vector<dealii::Point<3>> points;
    for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
      if (body == b)
        for (const unsigned int v : face->vertex_indices())
          points.push_back(face->vertex(v));
    });
    const dealii::BoundingBox<3> box(points);
    const dealii::Point<3> centre = box.center();
    const double size = (box.get_boundary_points().second - box.get_boundary_points().first).norm();

    RigidMotionGram supported, firmly; // by all but tools that press with a force, both ways
    std::vector<std::pair<Tensor<1, 3>, Tensor<1, 3>>> touching; // normal and arm
    std::vector<bool> used(bodies_[b].holds.size(), false);
    for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
      if (body != b)
        return;
      for (std::size_t h = 0; h < used.size(); ++h)
        if (holds_face(bodies_[b].holds[h], face, 1e-8 * size)) {
          used[h] = true;
          for (const unsigned int v : face->vertex_indices())
            supported.add(bodies_[b].holds[h].normal, (face->vertex(v) - centre) / size);
        }
      for (const auto &pair : pairs_)
        if (pair.body == b && std::find(pair.boundary_ids.begin(), pair.boundary_ids.end(),
                                        face->boundary_id()) != pair.boundary_ids.end()) {
          const Placement start = tools_[pair.tool].placement(0.);
          const double facet_size = std::sqrt(face->measure());
          for (const unsigned int v : face->vertex_indices()) {
            const auto projection = tools_[pair.tool].surface().project(start.to_tool(face->vertex(v)));
            if (!projection.exists || projection.gap > touching_gap * facet_size)
              continue;
            const Frame frame = Frame::from_normal(start.rotation * projection.normal);
            const Tensor<1, 3> arm = (face->vertex(v) - centre) / size;
            touching.emplace_back(frame.n, arm);
            if (tools_[pair.tool].control() != Tool::Control::force)
              firmly.add(frame.n, arm);
            if (pair.has_friction()) {
              supported.add(frame.q, arm);
              supported.add(frame.r, arm);
            }
          }
        }
    });
    for (std::size_t h = 0; h < used.size(); ++h)
      if (!used[h] && bodies_[b].holds[h].on_plane)
        throw InputError(parameters_.bodies[b].symmetry_planes.origin + ": found '" +
                         bodies_[b].holds[h].name.substr(std::string("symmetry plane ").size()) +
                         "', allowed are planes that hold boundary faces of body '" + bodies_[b].name +
                         "'; none lies in it");
    OneSidedRows contacts(supported.free_motions());
    for (const auto &[normal, arm] : touching)
      contacts.add(normal, arm);
    auto free = contacts.free_motions();
    // Tools that press with forces hold a body against something else, not between themselves.
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        firmly.values[i][j] += supported.values[i][j];
    if (free.empty())
      free = firmly.free_motions();
    if (!free.empty()) {
      const auto &motion = free.front();
      throw InputError(parameters_.bodies[b].origin +
                       ": the body is without support: at the start neither supports, nor symmetry planes, "
                       "nor tools that it touches "
                       "hold its rigid motion with translation " +
                       print(Tensor<1, 3>({motion[0], motion[1], motion[2]})) + " and rotation " +
                       print(Tensor<1, 3>({motion[3], motion[4], motion[5]})) +
                       ". Allowed in a static scene: none that is free");
    }
  }
}

void Scene::check_initial_penetration(const Triangulation<3> &mesh) const {
  for (const auto &pair : pairs_) {
    const Tool &tool = tools_[pair.tool];
    const Placement start = tool.placement(0.);
    double deepest = 0., size_there = 1.;
    Tensor<1, 3> where;
    for_each_boundary_face(mesh, [&](const std::size_t body, const auto &face) {
      if (body != pair.body || std::find(pair.boundary_ids.begin(), pair.boundary_ids.end(),
                                         face->boundary_id()) == pair.boundary_ids.end())
        return;
      const double h = std::sqrt(face->measure());
      for (const unsigned int v : face->vertex_indices()) {
        const double gap = tool.surface().project(start.to_tool(face->vertex(v))).gap; // none: positive
        if (gap / h < deepest / size_there) {
          deepest = gap;
          size_there = h;
          where = face->vertex(v);
        }
      }
    });
    const auto &allowed = pair.input->allowed_penetration;
    if (-deepest > allowed.value * size_there) {
      std::ostringstream message;
      message
          << pair.input->origin << ": body '" << bodies_[pair.body].name << "' starts " << -deepest
          << " deep (" << -deepest / size_there << " facet sizes) inside tool '" << tool.name()
          << "', deepest at " << print(where) << "; allowed are " << allowed.value
          << " facet sizes ('Allowed initial penetration'). Does the tool's normal point towards the body?";
      throw InputError(message.str());
    }
  }
}

} // namespace billet
