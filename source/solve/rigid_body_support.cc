// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/rigid_body_support.h"

#include "billet/algebra/gather.h"
#include "billet/geometry/frame.h"

#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace billet {

using dealii::Tensor;
using Rows = std::vector<std::vector<double>>;

namespace {

/// Limits, of vectors of length 1 unless they say otherwise.
struct RigidBodySupportLimits {
  /// Length of a row that counts as zero. Rows are unit vectors or shorter.
  static constexpr double no_row = 1e-6;
  /// Remainder that counts as zero: of the sum of all rows, as part of it, and of an aim.
  static constexpr double no_rest = 1e-2;
  /// Maximum number of sweeps of coordinate descent, and the decrease of the remainder in a sweep,
  /// as part of it, below which the sweeps end.
  static constexpr unsigned int max_sweeps = 1000;
  static constexpr double settled = 1e-6;
  /// Eigenvalue of Σ r rᵀ that counts as zero, as part of the largest eigenvalue or diagonal entry.
  static constexpr double no_eigenvalue = 1e-10;
  /// Length of the part of the bodies' motion that differs from other motions, below which it does
  /// not count.
  static constexpr double alike = 1e-3;
  /// Part of the slip of all spent points along the free motions below which it has no direction.
  static constexpr double no_slide = 1e-10;
  /// Component of a mode that is set to zero, as part of the motion of its body.
  static constexpr double no_component = 1e-2;
  /// Difference of components that count as equally large, as part of them.
  static constexpr double equal = 1e-6;
};

double dot(const std::vector<double> &a, const std::vector<double> &b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
}

/// Returns a combination of the orthonormal `basis` that none of the rows resists, r z >= 0 for
/// all; none if only 0 satisfies that. Farkas' lemma: all motions are resisted if the rows span the
/// basis and minus their sum is a combination Σ λ_i r_i with λ_i >= 0. Else the remainder is such a
/// motion. The method is coordinate descent.
std::optional<std::vector<double>> find_unresisted(const Rows &basis, const Rows &all_rows) {
  const std::size_t n = basis.size();
  if (n == 0)
    return {};
  const auto combine = [&](const std::vector<double> &factors) {
    std::vector<double> motion(basis.front().size(), 0.);
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < motion.size(); ++i)
        motion[i] += factors[k] * basis[k][i];
    return motion;
  };
  Rows rows;
  for (const auto &row : all_rows) {
    std::vector<double> part;
    for (const auto &motion : basis)
      part.push_back(dot(row, motion));
    if (dot(part, part) > RigidBodySupportLimits::no_row * RigidBodySupportLimits::no_row)
      rows.push_back(std::move(part));
  }
  // A motion orthogonal to all rows is free in both directions.
  dealii::LAPACKFullMatrix<double> gram(n, n);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t l = 0; l < n; ++l) {
      double sum = 0.;
      for (const auto &row : rows)
        sum += row[k] * row[l];
      gram(k, l) = sum;
    }
  dealii::Vector<double> values(n);
  dealii::FullMatrix<double> vectors(n, n);
  gram.compute_eigenvalues_symmetric(-std::numeric_limits<double>::max(), std::numeric_limits<double>::max(),
                                     0., values, vectors);
  std::vector<double> factors(n);
  if (rows.empty() || values[0] <= RigidBodySupportLimits::no_eigenvalue * values[n - 1]) {
    for (std::size_t k = 0; k < n; ++k)
      factors[k] = rows.empty() ? (k == 0 ? 1. : 0.) : vectors(k, 0);
    return combine(factors);
  }
  std::vector<double> rest(n, 0.), weights(rows.size(), 0.);
  for (const auto &row : rows)
    for (std::size_t k = 0; k < n; ++k)
      rest[k] += row[k];
  const double whole = std::sqrt(dot(rest, rest));
  double size = 0.;
  for (const auto &row : rows)
    size += dot(row, row);
  const auto is_small = [&] {
    const double left = std::sqrt(dot(rest, rest));
    return left <= RigidBodySupportLimits::no_rest * whole ||
           left <= RigidBodySupportLimits::no_row * std::sqrt(size);
  };
  for (unsigned int sweep = 0; sweep < RigidBodySupportLimits::max_sweeps && !is_small(); ++sweep)
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double change = std::max(-weights[i], -dot(rows[i], rest) / dot(rows[i], rows[i]));
      weights[i] += change;
      for (std::size_t k = 0; k < n; ++k)
        rest[k] += change * rows[i][k];
    }
  if (is_small())
    return {};
  const double left = std::sqrt(dot(rest, rest));
  for (std::size_t k = 0; k < n; ++k)
    factors[k] = rest[k] / left;
  return combine(factors);
}

/// Returns the point nearest to `aim` of the cone of z with r z >= 0 for all rows. The length of
/// `aim` is at most 1. Returns none if that point is 0. By Moreau's decomposition it is the aim
/// plus non-negative multiples of the rows. The method is coordinate descent.
std::optional<std::vector<double>> project_on_cone(const Rows &rows, std::vector<double> aim) {
  std::vector<double> weights(rows.size(), 0.);
  double before = std::sqrt(dot(aim, aim));
  for (unsigned int sweep = 0;
       sweep < RigidBodySupportLimits::max_sweeps && before > RigidBodySupportLimits::no_rest; ++sweep) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double square = dot(rows[i], rows[i]);
      if (square <= RigidBodySupportLimits::no_row * RigidBodySupportLimits::no_row)
        continue;
      const double change = std::max(-weights[i], -dot(rows[i], aim) / square);
      weights[i] += change;
      for (std::size_t k = 0; k < aim.size(); ++k)
        aim[k] += change * rows[i][k];
    }
    const double now = std::sqrt(dot(aim, aim));
    if (before - now <= RigidBodySupportLimits::settled * before)
      break;
    before = now;
  }
  if (std::sqrt(dot(aim, aim)) <= RigidBodySupportLimits::no_rest)
    return {};
  return aim;
}

/// Returns the products of each row with each motion.
Rows components_along(const Rows &motions, const Rows &rows) {
  Rows parts;
  for (const auto &row : rows) {
    std::vector<double> part;
    for (const auto &motion : motions)
      part.push_back(dot(row, motion));
    parts.push_back(std::move(part));
  }
  return parts;
}

/// Removes the direction of `motion` from the orthonormal `basis`, whose span contains it, and
/// makes the rest orthonormal.
void deflate(const std::vector<double> &motion, Rows &basis) {
  Rows left;
  std::vector<std::vector<double>> known{motion};
  const double size = std::sqrt(dot(motion, motion));
  for (double &component : known.front())
    component /= size;
  std::vector<std::size_t> order(basis.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](const std::size_t a, const std::size_t b) {
    return std::abs(dot(basis[a], motion)) < std::abs(dot(basis[b], motion));
  });
  for (const std::size_t k : order) {
    if (left.size() + 1 == basis.size())
      break;
    std::vector<double> vector = basis[k];
    for (const auto &other : known) {
      const double along = dot(vector, other);
      for (std::size_t i = 0; i < vector.size(); ++i)
        vector[i] -= along * other[i];
    }
    const double norm = std::sqrt(dot(vector, vector));
    for (double &component : vector)
      component /= norm;
    known.push_back(vector);
    left.push_back(vector);
  }
  basis = std::move(left);
}

} // namespace

RigidBodySupport::RigidBodySupport(const MPI_Comm communicator, std::vector<Body> bodies,
                                   const std::size_t n_tools)
    : communicator_(communicator), bodies_(std::move(bodies)), n_tools_(n_tools), gram_(n() * n(), 0.),
      slide_(n(), 0.) {}

void RigidBodySupport::add(const Tensor<1, 3> &position, const Tensor<1, 3> &direction, const Side &side,
                           const double sign, Row &row) const {
  if (side.body) {
    const Body &body = bodies_[*side.body];
    const Tensor<1, 3> turn = dealii::cross_product_3d((position - body.centre) / body.size, direction);
    for (unsigned int i = 0; i < 3; ++i) {
      row[6 * *side.body + i] += sign * direction[i];
      row[6 * *side.body + 3 + i] += sign * turn[i];
    }
  }
  if (side.tool)
    row[6 * bodies_.size() + *side.tool] += sign * (direction * side.tool_velocity);
}

void RigidBodySupport::add_both_ways(const Row &row) {
  for (std::size_t i = 0; i < row.size(); ++i)
    if (row[i] != 0.)
      for (std::size_t j = 0; j < row.size(); ++j)
        gram_[i * row.size() + j] += row[i] * row[j];
}

void RigidBodySupport::add_support(const std::size_t body, const Tensor<1, 3> &position,
                                   const Tensor<1, 3> &normal) {
  Row row(n(), 0.);
  add(position, normal, {body, {}, {}}, 1., row);
  add_both_ways(row);
}

RigidBodySupport::Row RigidBodySupport::row_of(const Tensor<1, 3> &position, const Tensor<1, 3> &direction,
                                               const Side &of, const Side &on) const {
  Row row(n(), 0.);
  add(position, direction, of, 1., row);
  add(position, direction, on, -1., row);
  return row;
}

void RigidBodySupport::add_contact(const SupportingPoint &point, const Side &of, const Side &on) {
  add_both_ways(row_of(point.position, point.normal, of, on));
  add_friction(point, of, on);
}

void RigidBodySupport::add_pushing_contact(const SupportingPoint &point, const Side &of, const Side &on) {
  add_one_way(row_of(point.position, point.normal, of, on));
  add_friction(point, of, on);
}

void RigidBodySupport::add_load(const std::size_t tool, const double load) {
  Row row(n(), 0.);
  row[6 * bodies_.size() + tool] = load < 0. ? -1. : 1.;
  add_one_way(row);
}

void RigidBodySupport::hold(const std::size_t body) {
  for (std::size_t i = 6 * body; i < 6 * body + 6; ++i) {
    Row row(n(), 0.);
    row[i] = 1.;
    add_both_ways(row);
  }
}

void RigidBodySupport::add_friction(const SupportingPoint &point, const Side &of, const Side &on) {
  if (point.friction == SupportingPoint::Friction::none)
    return;
  const bool slips = point.friction == SupportingPoint::Friction::slips;
  const Frame frame = Frame::from_normal(point.normal);
  const Tensor<1, 3> along = slips ? point.slip : frame.q;
  const Tensor<1, 3> across = slips ? dealii::cross_product_3d(point.normal, along) : frame.r;
  add_both_ways(row_of(point.position, across, of, on));
  const Row row = row_of(point.position, along, of, on);
  if (slips)
    add_one_way(row);
  else
    add_both_ways(row);
}

void RigidBodySupport::add_unloaded_contact(const SupportingPoint &point, const Side &of, const Side &on) {
  add_one_way(row_of(point.position, point.normal, of, on));
}

void RigidBodySupport::add_spent_contact(const SupportingPoint &point, const Side &of, const Side &on) {
  add_both_ways(row_of(point.position, point.normal, of, on));
  const Row row = row_of(point.position, point.slip, of, on);
  for (std::size_t i = 0; i < n(); ++i)
    slide_[i] += row[i];
}

RigidBodySupport::Mode RigidBodySupport::mode_of(const Row &motion) const {
  Mode mode{0, {}};
  double maximum = 0.;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const double square = std::inner_product(&motion[6 * body], &motion[6 * body] + 6, &motion[6 * body], 0.);
    if (square > maximum) {
      maximum = square;
      mode.body = body;
    }
  }
  double max_component = 0.; // largest component, which is made positive
  for (unsigned int i = 0; i < 6; ++i)
    if (std::abs(motion[6 * mode.body + i]) > (1. + RigidBodySupportLimits::equal) * std::abs(max_component))
      max_component = motion[6 * mode.body + i];
  const auto component = [&](const unsigned int i) {
    const double value = motion[6 * mode.body + i] / (std::sqrt(maximum) * (max_component < 0. ? -1. : 1.));
    return std::abs(value) < RigidBodySupportLimits::no_component ? 0. : value;
  };
  mode.motion = {Tensor<1, 3>({component(0), component(1), component(2)}),
                 Tensor<1, 3>({component(3), component(4), component(5)})};
  return mode;
}

RigidBodySupport::Unresisted RigidBodySupport::find_unresisted_both_ways() const {
  const std::size_t size = n(), n_of_bodies = 6 * bodies_.size();
  std::vector<double> gram(gram_);
  dealii::Utilities::MPI::sum(gram_, communicator_, gram);
  dealii::LAPACKFullMatrix<double> matrix(size, size);
  double maximum = 0.;
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j) {
      matrix(i, j) = gram[i * size + j];
      maximum = std::max(maximum, i == j ? gram[i * size + j] : 0.);
    }
  dealii::Vector<double> values(size);
  dealii::FullMatrix<double> vectors(size, size);
  matrix.compute_eigenvalues_symmetric(-std::numeric_limits<double>::max(),
                                       std::numeric_limits<double>::max(), 0., values, vectors);
  Unresisted found;
  Rows bodies;
  for (std::size_t k = 0;
       k < size && (maximum == 0. || values[k] <= RigidBodySupportLimits::no_eigenvalue * maximum); ++k) {
    Row motion(size), of_bodies;
    for (std::size_t i = 0; i < size; ++i)
      motion[i] = vectors(i, k);
    found.all.push_back(motion);
    of_bodies.assign(motion.begin(), motion.begin() + static_cast<std::ptrdiff_t>(n_of_bodies));
    for (const auto &other : bodies) {
      const double along = dot(of_bodies, other);
      for (std::size_t i = 0; i < n_of_bodies; ++i)
        of_bodies[i] -= along * other[i];
    }
    const double left = std::sqrt(dot(of_bodies, of_bodies));
    if (left <= RigidBodySupportLimits::alike)
      continue;
    for (double &component : of_bodies)
      component /= left;
    bodies.push_back(of_bodies);
    found.of_bodies.push_back(motion);
  }
  return found;
}

std::vector<RigidBodySupport::Row> RigidBodySupport::gather_one_way() const {
  Rows rows;
  const auto size = static_cast<std::ptrdiff_t>(n());
  for (const auto &part : all_gather(communicator_, one_way_))
    for (auto row = part.begin(); row != part.end(); row += size)
      rows.emplace_back(row, row + size);
  return rows;
}

RigidBodySupport::Mode RigidBodySupport::find_sliding(const std::vector<Row> &motions) const {
  Row slide(n()), sliding(n());
  dealii::Utilities::MPI::sum(slide_, communicator_, slide);
  for (const auto &motion : motions)
    for (std::size_t i = 0; i < n(); ++i)
      sliding[i] += dot(motion, slide) * motion[i];
  const bool has_direction = dot(sliding, sliding) > RigidBodySupportLimits::no_slide *
                                                         RigidBodySupportLimits::no_slide * dot(slide, slide);
  return mode_of(has_direction ? sliding : motions.front());
}

void RigidBodySupport::find_pushed(const std::vector<Row> &motions, const std::vector<Row> &one_way,
                                   Result &result) const {
  const Rows parts = components_along(motions, one_way);
  result.free.reset();
  for (std::size_t i = 0; i < 6 * bodies_.size(); ++i)
    for (const double sign : {-1., 1.}) {
      if (result.is_free[i / 6])
        continue;
      std::vector<double> aim;
      for (const auto &motion : motions)
        aim.push_back(sign * motion[i]);
      const auto factors = project_on_cone(parts, std::move(aim));
      if (!factors)
        continue;
      result.is_free[i / 6] = true;
      Row motion(n(), 0.);
      for (std::size_t k = 0; k < motions.size(); ++k)
        for (std::size_t j = 0; j < n(); ++j)
          motion[j] += (*factors)[k] * motions[k][j];
      if (!result.free)
        result.free = mode_of(motion);
    }
}

std::vector<Tensor<1, 3>> RigidBodySupport::find_unresisted_part(const std::vector<Tensor<1, 3>> &set,
                                                                 const std::vector<Row> &motions,
                                                                 const std::vector<Row> &one_way) const {
  std::vector<Tensor<1, 3>> result(bodies_.size());
  double square = 0.;
  for (const Tensor<1, 3> &translation : set)
    square += translation.norm_square();
  if (!(square > 0.))
    return result;
  const double size = std::sqrt(square);
  std::vector<double> aim;
  for (const Row &motion : motions) {
    double along = 0.;
    for (std::size_t body = 0; body < bodies_.size(); ++body)
      for (unsigned int i = 0; i < 3; ++i)
        along += motion[6 * body + i] * set[body][i] / size;
    aim.push_back(along);
  }
  const auto factors = project_on_cone(components_along(motions, one_way), std::move(aim));
  if (!factors)
    return result;
  for (std::size_t k = 0; k < motions.size(); ++k)
    for (std::size_t body = 0; body < bodies_.size(); ++body)
      for (unsigned int i = 0; i < 3; ++i)
        result[body][i] += size * (*factors)[k] * motions[k][6 * body + i];
  return result;
}

RigidBodySupport::Result RigidBodySupport::find() const {
  Unresisted motions = find_unresisted_both_ways();
  Rows &basis = motions.of_bodies;
  Result result;
  if (pushes_)
    result.is_free.assign(bodies_.size(), false);
  if (basis.empty() && !pushes_)
    return result;
  const Rows one_way = gather_one_way();
  if (!basis.empty())
    result.sliding = find_sliding(basis);
  while (const auto motion = find_unresisted(basis, one_way)) {
    if (!result.free)
      result.free = mode_of(*motion);
    ++result.n_free;
    deflate(*motion, basis);
  }
  if (pushes_)
    find_pushed(motions.all, one_way, result);
  for (const auto &set : sets_)
    result.unresisted.push_back(find_unresisted_part(set, motions.all, one_way));
  return result;
}

} // namespace billet
