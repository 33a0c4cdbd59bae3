// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/rigid_motions.h"

#include "billet/geometry/curve.h"
#include "billet/geometry/frame.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace billet {

using dealii::Tensor;
using Sense = Resistance::Sense;

namespace {

/// Sum of r rᵀ over constraint rows r = (n, (x − c) × n / L) on the six rigid-body motions
/// (translation, rotation · L).
struct RigidMotionGram {
  std::array<std::array<double, 6>, 6> values{};
  void add(const std::array<double, 6> &row) {
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        values[i][j] += row[i] * row[j];
  }
  /// Returns the rigid-body modes that no row resists.
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

/// Rows that resist a motion in one direction only: contact carries no tension.
class OneSidedRows {
public:
  /// `free`: the modes that are not resisted in both directions.
  explicit OneSidedRows(std::vector<std::array<double, 6>> free) : free_(std::move(free)) {}

  void add(const std::array<double, 6> &row) {
    std::vector<double> part(free_.size(), 0.);
    for (std::size_t k = 0; k < free_.size(); ++k)
      for (unsigned int i = 0; i < 6; ++i)
        part[k] += row[i] * free_[k][i];
    rows_.push_back(part);
  }

  /// Returns a motion that no row resists, if there is one. All motions are resisted if the rows
  /// r_i span the space with factors λ_i >= 0. This holds if minus their sum can be written as Σ
  /// λ_i r_i; otherwise the remainder is such a motion (Farkas). Coordinate descent finds the
  /// factors.
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
    // Motions orthogonal to all rows are free in both directions.
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

void add_contact(const Tensor<1, 3> &position, const Tensor<1, 3> &normal, const bool presses_with_force,
                 const bool has_friction, std::vector<Resistance> &resistances) {
  resistances.push_back({position, normal, presses_with_force ? Sense::force_push : Sense::push});
  if (!has_friction)
    return;
  const Frame frame = Frame::from_normal(normal);
  resistances.push_back({position, frame.q, Sense::both_ways});
  resistances.push_back({position, frame.r, Sense::both_ways});
}

std::string print(const RigidMotion &motion) {
  return "translation " + print(motion.translation) + " and rotation " + print(motion.rotation);
}

std::optional<RigidMotion> find_free_motion(const std::vector<Resistance> &resistances,
                                            const Tensor<1, 3> &centre, const double size) {
  const auto row_of = [&](const Resistance &resistance) {
    const Tensor<1, 3> &n = resistance.direction;
    const Tensor<1, 3> m = dealii::cross_product_3d((resistance.position - centre) / size, n);
    return std::array<double, 6>{n[0], n[1], n[2], m[0], m[1], m[2]};
  };
  RigidMotionGram supported, firmly; // firmly: without force-controlled tools
  for (const auto &resistance : resistances) {
    if (resistance.sense == Sense::both_ways)
      supported.add(row_of(resistance));
    if (resistance.sense != Sense::force_push)
      firmly.add(row_of(resistance));
  }
  OneSidedRows contacts(supported.free_motions());
  for (const auto &resistance : resistances)
    if (resistance.sense != Sense::both_ways)
      contacts.add(row_of(resistance));
  auto free = contacts.free_motions();
  if (free.empty())
    free = firmly.free_motions();
  if (free.empty())
    return {};
  const auto &motion = free.front();
  return RigidMotion{Tensor<1, 3>({motion[0], motion[1], motion[2]}),
                     Tensor<1, 3>({motion[3], motion[4], motion[5]})};
}

} // namespace billet
