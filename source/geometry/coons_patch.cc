// SPDX-License-Identifier: LGPL-2.1-or-later
// Coons patch and its cells; coons_closest_point.cc searches them.
#include "billet/geometry/coons_patch.h"

#include "billet/geometry/self_crossing.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace billet {

using CoonsPoint = CoonsPatch::Point;
using CurveKind = CurveSketch::Kind;

namespace {

// Maximum distance of curves that meet, relative to the patch's size.
constexpr double meeting_ends = 1e-8;
// Maximum change of direction in a cell [radians], such that Newton's method from its middle is
// safe and its box is tight.
constexpr double cell_angle = 0.2;
constexpr unsigned int facets_per_cell =
    2; // along a side, for output and for the search for folds and intersections

double sketch_size(const std::array<CurveSketch, 4> &round) {
  double size = 0.;
  for (const auto &curve : round)
    for (const auto &point : curve.points)
      size = std::max(size, (point - round[0].points[0]).norm());
  return size;
}

/// Returns the curves, each starting exactly at the end of the previous one.
std::array<CurveSketch, 4> joined(std::array<CurveSketch, 4> round, const double size) {
  for (unsigned int i = 0; i < 4; ++i) {
    const unsigned int j = (i + 1) % 4;
    const CoonsPoint &end = round[i].points.back();
    CoonsPoint &start = round[j].points.front();
    const double apart = (end - start).norm();
    if (apart > meeting_ends * size) {
      std::ostringstream reason;
      reason << "curve " << i + 1 << " ends at " << print(end) << ", but curve " << j + 1 << " begins at "
             << print(start) << ", " << apart << " from there";
      throw std::invalid_argument(reason.str());
    }
    if (round[i].kind == CurveKind::point && round[j].kind == CurveKind::point)
      throw std::invalid_argument("curves " + std::to_string(std::min(i, j) + 1) + " and " +
                                  std::to_string(std::max(i, j) + 1) +
                                  ", which are neighbours, are both points");
    // A point moves as a whole; the previous curve meets it within the tolerance.
    start = end;
  }
  return round;
}

Curve make_curve(const CurveSketch &sketch, const unsigned int number) {
  try {
    return Curve(sketch);
  } catch (const std::invalid_argument &error) {
    throw std::invalid_argument("curve " + std::to_string(number) + ": " + error.what());
  }
}

CoonsPoint maximum(const CoonsPoint &a, const CoonsPoint &b) {
  return CoonsPoint({std::max(a[0], b[0]), std::max(a[1], b[1]), std::max(a[2], b[2])});
}

} // namespace

CoonsPatch::CoonsPatch(const std::array<CurveSketch, 4> &round) : size_(sketch_size(round)) {
  const std::array<CurveSketch, 4> sketches = joined(round, size_);
  for (unsigned int i = 0; i < 4; ++i) {
    curves_.push_back(make_curve(i < 2 ? sketches[i] : sketches[i].reversed(), i + 1));
    is_pole_[i] = sketches[i].kind == CurveKind::point;
    corners_[i] = sketches[i].points.front();
  }
  measure();
  make_cells();
  refuse_folds();
  refuse_crossings();
}

CoonsPatch::Jet CoonsPatch::at(const double u, const double v) const {
  const Curve::Jet c0 = curves_[0].at(u), d1 = curves_[1].at(v), c1 = curves_[2].at(u), d0 = curves_[3].at(v);
  const double U = 1. - u, V = 1. - v;
  const CoonsPoint low = U * corners_[0] + u * corners_[1], high = U * corners_[3] + u * corners_[2];
  const CoonsPoint along_low = corners_[1] - corners_[0], along_high = corners_[2] - corners_[3];
  return {V * (c0.position - low) + v * (c1.position - high) + U * d0.position + u * d1.position,
          V * (c0.first - along_low) + v * (c1.first - along_high) + (d1.position - d0.position),
          (c1.position - high) - (c0.position - low) + U * d0.first + u * d1.first,
          V * c0.second + v * c1.second,
          (c1.first - along_high) - (c0.first - along_low) + d1.first - d0.first,
          U * d0.second + u * d1.second};
}

CoonsPoint CoonsPatch::normal(const Jet &jet, const double u, const double v) const {
  const double nothing = 1e-8 * length_u_ * length_v_;
  CoonsPoint normal = dealii::cross_product_3d(jet.u, jet.v);
  double length = normal.norm();
  if (length < nothing) {
    // First order: (X_u × X_v)_u and (X_u × X_v)_v times the distance to the middle.
    normal = (0.5 - u) * (dealii::cross_product_3d(jet.uu, jet.v) + dealii::cross_product_3d(jet.u, jet.uv)) +
             (0.5 - v) * (dealii::cross_product_3d(jet.uv, jet.v) + dealii::cross_product_3d(jet.u, jet.vv));
    length = normal.norm();
  }
  return length < nothing ? CoonsPoint() : normal / length;
}

/// Computes the lengths and, from them, the number of cells.
void CoonsPatch::measure() {
  constexpr unsigned int n = 6;
  double square_u = 0., square_v = 0., twist = 0., area = 0.;
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j < n; ++j) {
      const Jet jet = at((i + 0.5) / n, (j + 0.5) / n);
      square_u += jet.u.norm_square() / (n * n);
      square_v += jet.v.norm_square() / (n * n);
      twist = std::max(twist, jet.uv.norm());
      area = std::max(area, dealii::cross_product_3d(jet.u, jet.v).norm());
    }
  if (!(area > meeting_ends * size_ * size_))
    throw std::invalid_argument("the patch has no area");
  length_u_ = std::sqrt(square_u);
  length_v_ = std::sqrt(square_v);
  const double second_u =
                   std::max(curves_[0].max_second(0., 1.).norm(), curves_[2].max_second(0., 1.).norm()),
               second_v =
                   std::max(curves_[1].max_second(0., 1.).norm(), curves_[3].max_second(0., 1.).norm());
  const auto count = [&](const double second, const double own, const double other) {
    const double angle = std::max(second / own, twist / other);
    return static_cast<unsigned int>(
        std::clamp(std::ceil(angle / cell_angle), 1. * fewest_cells, 1. * max_cells));
  };
  n_u_ = count(second_u, length_u_, length_v_);
  n_v_ = count(second_v, length_v_, length_u_);
}

void CoonsPatch::make_cells() {
  box_ = BoundingBox::empty();
  for (unsigned int i = 0; i < n_u_; ++i)
    for (unsigned int j = 0; j < n_v_; ++j) {
      cells_.push_back(make_cell(i, j));
      Cell &cell = cells_.back();
      double radius = 0.;
      for (const auto &arm : cell.arms) {
        radius = std::max(radius, arm.norm() + cell.slack.norm());
        box_.add(cell.middle.position + arm + cell.slack);
        box_.add(cell.middle.position + arm - cell.slack);
      }
      balls_.push_back({cell.middle.position, radius});
    }
}

CoonsPatch::Cell CoonsPatch::make_cell(const unsigned int i, const unsigned int j) const {
  const double h_u = 1. / n_u_, h_v = 1. / n_v_;
  Cell cell{};
  cell.range = {i * h_u, i + 1 < n_u_ ? (i + 1) * h_u : 1., j * h_v, j + 1 < n_v_ ? (j + 1) * h_v : 1.};
  const auto &[low_u, high_u, low_v, high_v] = cell.range;
  cell.middle = at((i + 0.5) * h_u, (j + 0.5) * h_v);
  cell.arms = {
      at(low_u, low_v).position - cell.middle.position, at(high_u, low_v).position - cell.middle.position,
      at(high_u, high_v).position - cell.middle.position, at(low_u, high_v).position - cell.middle.position};
  // X_uu and X_vv are means of the curves' second derivatives.
  const CoonsPoint uu = maximum(curves_[0].max_second(low_u, high_u), curves_[2].max_second(low_u, high_u)),
                   vv = maximum(curves_[1].max_second(low_v, high_v), curves_[3].max_second(low_v, high_v));
  cell.slack = h_u * h_u / 8. * uu + h_v * h_v / 8. * vv;
  // X_uuv = c_1'' − c_0'' and X_uvv = d_1'' − d_0'' change with the curves' third derivatives.
  const auto third = [](const Curve &a, const Curve &b, const double from, const double to) {
    const double middle = 0.5 * (from + to);
    const double change = a.max_third(from, to) + b.max_third(from, to);
    return (a.at(middle).second - b.at(middle).second).norm() + 0.5 * (to - from) * change;
  };
  const double uuv = third(curves_[2], curves_[0], low_u, high_u),
               uvv = third(curves_[1], curves_[3], low_v, high_v);
  const double uv = (cell.middle.uv.norm() + 0.5 * (h_u * uuv + h_v * uvv)) / (length_u_ * length_v_);
  cell.bend_u = uu.norm() / (length_u_ * length_u_) + uv;
  cell.bend_v = vv.norm() / (length_v_ * length_v_) + uv;
  cell.uuu = std::max(curves_[0].max_third(low_u, high_u), curves_[2].max_third(low_u, high_u)) /
             std::pow(length_u_, 3);
  cell.uuv = uuv / (length_u_ * length_u_ * length_v_);
  cell.uvv = uvv / (length_u_ * length_v_ * length_v_);
  cell.vvv = std::max(curves_[1].max_third(low_v, high_v), curves_[3].max_third(low_v, high_v)) /
             std::pow(length_v_, 3);
  return cell;
}

void CoonsPatch::refuse_folds() const {
  const unsigned int n_u = facets_per_cell * n_u_, n_v = facets_per_cell * n_v_;
  std::vector<CoonsPoint> row_before, row;
  for (unsigned int i = 0; i <= n_u; ++i) {
    row.clear();
    for (unsigned int j = 0; j <= n_v; ++j) {
      const double u = i / static_cast<double>(n_u), v = j / static_cast<double>(n_v);
      const Jet jet = at(u, v);
      row.push_back(normal(jet, u, v));
      const bool is_fold = row[j].norm() == 0. || (j > 0 && row[j] * row[j - 1] <= 0.) ||
                           (i > 0 && row[j] * row_before[j] <= 0.);
      if (is_fold)
        throw std::invalid_argument("the patch folds over, or its sides cross, near " + print(jet.position));
    }
    std::swap(row, row_before);
  }
}

void CoonsPatch::refuse_crossings() const {
  const unsigned int n_u = facets_per_cell * n_u_, n_v = facets_per_cell * n_v_;
  // The steps are unequal. With equal steps the corners of two sheets that cross symmetrically
  // would coincide, and no triangle would pierce another.
  const auto parameter = [](const unsigned int i, const unsigned int n) {
    const double t = i / static_cast<double>(n);
    return t + 0.1 * t * (1. - t);
  };
  std::vector<CoonsPoint> points;
  std::vector<std::array<unsigned int, 3>> triangles;
  for (unsigned int i = 0; i <= n_u; ++i)
    for (unsigned int j = 0; j <= n_v; ++j)
      points.push_back(at(parameter(i, n_u), parameter(j, n_v)).position);
  // All points of a side that is a point are its first.
  const auto corner = [&](unsigned int i, unsigned int j) {
    if ((j == 0 && is_pole_[0]) || (j == n_v && is_pole_[2]))
      i = 0;
    if ((i == 0 && is_pole_[3]) || (i == n_u && is_pole_[1]))
      j = 0;
    return i * (n_v + 1) + j;
  };
  for (unsigned int i = 0; i < n_u; ++i)
    for (unsigned int j = 0; j < n_v; ++j) {
      triangles.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
      triangles.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
    }
  if (const auto where = find_self_crossing(points, triangles))
    throw std::invalid_argument("the patch crosses itself near " + print(*where));
}

void CoonsPatch::draw(const OutputRegion &, SurfaceMesh &surface_mesh) const {
  const unsigned int n_u = facets_per_cell * n_u_, n_v = facets_per_cell * n_v_;
  const auto first = static_cast<unsigned int>(surface_mesh.points.size());
  for (unsigned int i = 0; i <= n_u; ++i)
    for (unsigned int j = 0; j <= n_v; ++j)
      surface_mesh.points.push_back(at(i / static_cast<double>(n_u), j / static_cast<double>(n_v)).position);
  for (unsigned int i = 0; i < n_u; ++i)
    for (unsigned int j = 0; j < n_v; ++j) {
      const unsigned int corner = first + i * (n_v + 1) + j;
      std::vector<unsigned int> facet;
      for (const unsigned int next : {corner, corner + n_v + 1, corner + n_v + 2, corner + 1}) {
        const auto coincides = [&](const unsigned int other) {
          return (surface_mesh.points[other] - surface_mesh.points[next]).norm() <= meeting_ends * size_;
        };
        if (std::none_of(facet.begin(), facet.end(), coincides))
          facet.push_back(next);
      }
      surface_mesh.facets.push_back(facet);
    }
}

} // namespace billet
