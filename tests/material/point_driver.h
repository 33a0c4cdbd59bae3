// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MATERIAL_POINT_DRIVER_H
#define BILLET_TESTS_MATERIAL_POINT_DRIVER_H

#include "moduli.h"

#include <stdexcept>

/// What tests of laws with a state share: points that are driven by some strains and stresses, and moduli.
namespace billet::testing {

/// A point whose F is symmetric: F = exp(e) with a logarithmic strain e in space, in the order 11, 22, 33,
/// 12, 13, 23. Some components are given, for the others Kirchhoff's stress is.
template <class Law> class DrivenPoint {
public:
  explicit DrivenPoint(const Law &law, const double dt = 1.) : law_(law) { step_.dt = dt; }

  /// Moves to these strains where `is_given`; elsewhere to these stresses, by Newton's method with
  /// differences. Throws std::runtime_error if that fails.
  void move(const std::array<bool, 6> &is_given, const std::array<double, 6> &values) {
    constexpr double small = 1e-7;
    for (unsigned int i = 0; i < 6; ++i)
      if (is_given[i])
        strain[i] = values[i];
    std::vector<unsigned int> free;
    for (unsigned int i = 0; i < 6; ++i)
      if (!is_given[i])
        free.push_back(i);
    const std::size_t n = free.size();
    double best = std::numeric_limits<double>::infinity();
    for (unsigned int iteration = 0; iteration < 60; ++iteration) {
      const auto now = respond(strain);
      std::vector<double> residual(n);
      double size = 0.;
      for (std::size_t i = 0; i < n; ++i) {
        residual[i] = now[free[i]] - values[free[i]];
        size += residual[i] * residual[i];
      }
      size = std::sqrt(size);
      if (size == 0. || (size < 1e-7 && size >= 0.5 * best))
        break;
      best = std::min(best, size);
      dealii::FullMatrix<double> slope(static_cast<unsigned int>(n), static_cast<unsigned int>(n));
      for (unsigned int k = 0; k < n; ++k) {
        auto high = strain, low = strain;
        high[free[k]] += small;
        low[free[k]] -= small;
        const auto up = respond(high), down = respond(low);
        for (unsigned int i = 0; i < n; ++i)
          slope(i, k) = (up[free[i]] - down[free[i]]) / (2. * small);
      }
      slope.gauss_jordan();
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int i = 0; i < n; ++i)
          strain[free[k]] -= slope(k, i) * residual[i];
    }
    stress = respond(strain);
    history = next_;
  }

  std::array<double, 6> strain{}, stress{};
  typename Law::History history;

private:
  std::array<double, 6> respond(const std::array<double, 6> &at) {
    constexpr unsigned int rows[6] = {0, 1, 2, 0, 0, 1}, columns[6] = {0, 1, 2, 1, 2, 2};
    SymmetricTensor<2, 3> e, tau;
    for (unsigned int i = 0; i < 6; ++i)
      e[rows[i]][columns[i]] = at[i];
    if (!law_.update(exponential(e), history, next_, tau, nullptr, step_))
      throw std::runtime_error("the point fails");
    std::array<double, 6> result{};
    for (unsigned int i = 0; i < 6; ++i)
      result[i] = tau[rows[i]][columns[i]];
    return result;
  }

  const Law &law_;
  PointStep step_;
  typename Law::History next_;
};

/// Random steps of random size about a growing deformation.
template <class Visit> void follow_path(const double size, const unsigned int n, const Visit &visit) {
  Random random;
  Tensor<2, 3> F = unit;
  for (unsigned int i = 0; i < n; ++i) {
    F = (unit + random.tensor(size)) * F;
    F /= std::cbrt(dealii::determinant(F));
    visit(F);
  }
}

/// Compares the moduli with differences along paths of `n_steps` of three sizes, and checks that dissipation
/// never decreases. The paths must yield more than `min_yields` times.
template <class Law>
void test_moduli(const std::string &name, const Law &law, const PointStep &step, const unsigned int n_steps,
                 const unsigned int min_yields) {
  WorstError error;
  double least_dissipation = 1e300;
  unsigned int n_yields = 0;
  for (const double size : {2e-3, 2e-2, 0.2}) {
    typename Law::History history_n, history;
    follow_path(size, n_steps, [&](const Tensor<2, 3> &F) {
      SymmetricTensor<2, 3> tau;
      SpatialModuli c;
      if (!law.update(F, history_n, history, tau, &c, step))
        return check(name + " fails", false);
      least_dissipation =
          std::min(least_dissipation, law.plastic_work(history) - law.plastic_work(history_n));
      if (history.equivalent_plastic_strain > history_n.equivalent_plastic_strain + 1e-4) {
        ++n_yields;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j) {
            Tensor<2, 3> L;
            L[i][j] += 1.;
            L[j][i] += i <= j ? 1. : -1.;
            const SymmetricTensor<2, 3> difference = central_difference(
                [&](const double e) {
                  typename Law::History ignored;
                  SymmetricTensor<2, 3> at;
                  law.update((unit + e * L) * F, history_n, ignored, at, nullptr, step);
                  return at;
                },
                1e-5);
            error.add((predict(c, tau, L) - static_cast<Tensor<2, 3>>(difference)).norm() / norm(c));
          }
      }
      history_n = history;
    });
  }
  check(name + ", it yields", n_yields > min_yields);
  check(name + ", moduli", error.value(), 1e-7);
  check(name + ", dissipation", -least_dissipation, 1e-12);
}

} // namespace billet::testing

#endif
