// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_CHECK_SURFACE_H
#define BILLET_TESTS_CHECK_SURFACE_H

#include "make_surface.h"

#include "../testing.h"

namespace billet::testing {

/// What must hold for any surface, at random points in a box of `size` about `centre`: the contact point lies
/// on the surface; no point of its picture is nearer, unless the facets' chords are (`chord`, for surfaces
/// whose pictures' corners lie on them: round-off); the normal is the gap's gradient and `turning` the
/// normal's, by central differences; the guess of the patch does not matter; the box holds the picture.
inline void check_surface(const std::string &name, const RigidSurface &surface,
                          const dealii::Tensor<1, 3> &centre, const double size,
                          const unsigned int n_points = 400, const double accuracy = 1e-9) {
  using dealii::Tensor;
  Random random;
  const SurfaceMesh surface_mesh = surface.surface_mesh({centre, size});
  WorstError on_surface, nearer, gradient, turning, guess, outside_box, unit;
  unsigned int n_exist = 0, n_smooth = 0;
  for (const auto &point : surface_mesh.points)
    outside_box.add(std::sqrt(surface.bounding_box().distance_square(point)) / size);
  for (unsigned int i = 0; i < n_points; ++i) {
    // A tenth of the points far away.
    const double reach = i % 10 == 0 ? 30. * size : size;
    const Tensor<1, 3> x = centre + random.vector(reach);
    const auto here = surface.project(x);
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto &point : surface_mesh.points)
      nearest = std::min(nearest, (x - point).norm());
    nearer.add(std::max(0., std::abs(here.gap) - nearest) / reach);
    const auto &elsewhere = surface_mesh.points[i % surface_mesh.points.size()];
    const auto other = surface.project(x, surface.project(elsewhere).patch);
    guess.add(std::abs(other.gap - here.gap) / reach);
    if (!here.exists)
      continue;
    ++n_exist;
    unit.add(std::abs(here.normal.norm() - 1.));
    const auto foot = surface.project(x - here.gap * here.normal);
    on_surface.add(std::abs(foot.gap) / reach);

    // Derivatives, where the contact point runs smoothly: not across edges and medial lines.
    const double h = 1e-5 * size;
    Tensor<1, 3> gap_gradient;
    Tensor<2, 3> normal_gradient;
    bool is_smooth = true;
    for (unsigned int c = 0; c < 3; ++c) {
      const auto at = [&](const double step) {
        Tensor<1, 3> moved = x;
        moved[c] += step;
        return surface.project(moved);
      };
      const auto p = at(h), m = at(-h), pp = at(2. * h), mm = at(-2. * h);
      for (const auto &side : {p, m, pp, mm})
        is_smooth =
            is_smooth && side.exists && side.patch == here.patch && (side.normal - here.normal).norm() < 0.01;
      gap_gradient[c] = (8. * (p.gap - m.gap) - (pp.gap - mm.gap)) / (12. * h);
      const Tensor<1, 3> column = (8. * (p.normal - m.normal) - (pp.normal - mm.normal)) / (12. * h);
      const Tensor<1, 3> left = (p.normal - here.normal) / h, right = (here.normal - m.normal) / h;
      // The curvature jumps where an arc meets a line.
      is_smooth = is_smooth && (left - right).norm() * size < 1e-2 * (1. + left.norm() * size);
      for (unsigned int d = 0; d < 3; ++d)
        normal_gradient[d][c] = column[d];
    }
    if (!is_smooth)
      continue;
    ++n_smooth;
    gradient.add((gap_gradient - here.normal).norm());
    turning.add((normal_gradient - here.turning).norm() * size / (1. + here.turning.norm() * size));
  }
  check(name + ": some points have a contact point", n_exist > 10);
  check(name + ": most of them smoothly", 2 * n_smooth > n_exist);
  check(name + ": normals are unit vectors", unit.value(), 1e-12);
  check(name + ": the contact point lies on the surface", on_surface.value(), accuracy);
  check(name + ": no point of the picture is nearer", nearer.value(), accuracy);
  check(name + ": the guess of the patch does not matter", guess.value(), accuracy);
  check(name + ": the normal is the gap's gradient", gradient.value(), 1e-8);
  check(name + ": turning is the normal's", turning.value(), 1e-5);
  check(name + ": the box holds the picture", outside_box.value(), 1e-12);
}

} // namespace billet::testing

#endif
