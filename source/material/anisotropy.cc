// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/anisotropy.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

HillCoefficients HillCoefficients::from_r_values(const double r0, const double r45, const double r90) {
  HillCoefficients result;
  result.G = 1. / (1. + r0);
  result.H = r0 * result.G;
  result.F = result.H / r90;
  result.N = (result.F + result.G) * (r45 + 0.5);
  return result;
}

HillCoefficients HillCoefficients::from_stress_ratios(const std::array<double, 6> &ratios) {
  std::array<double, 6> inverse{};
  for (unsigned int i = 0; i < 6; ++i)
    inverse[i] = 1. / (ratios[i] * ratios[i]);
  HillCoefficients result;
  result.F = 0.5 * (inverse[1] + inverse[2] - inverse[0]);
  result.G = 0.5 * (inverse[2] + inverse[0] - inverse[1]);
  result.H = 0.5 * (inverse[0] + inverse[1] - inverse[2]);
  result.N = 1.5 * inverse[3];
  result.M = 1.5 * inverse[4];
  result.L = 1.5 * inverse[5];
  return result;
}

bool HillCoefficients::is_convex() const {
  return std::min({L, M, N}) > 0. && F + G + H > 0. && F * G + G * H + H * F > 0.;
}

Matrix6 HillCoefficients::matrix(const std::array<dealii::Tensor<1, 3>, 3> &axes) const {
  const Matrix6 local = {{{G + H, -H, -G, 0., 0., 0.},
                          {-H, F + H, -F, 0., 0., 0.},
                          {-G, -F, F + G, 0., 0., 0.},
                          {0., 0., 0., N, 0., 0.},
                          {0., 0., 0., 0., M, 0.},
                          {0., 0., 0., 0., 0., L}}};
  dealii::Tensor<2, 3> Q; // columns: axes
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int a = 0; a < 3; ++a)
      Q[i][a] = axes[a][i];
  const Matrix6 K = rotation_of(Q);
  Matrix6 result{};
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      for (unsigned int k = 0; k < 6; ++k)
        result[i][j] += dot(local[k], K[j]) * K[i][k];
  return result;
}

std::string Anisotropy::description() const {
  std::ostringstream text;
  text.precision(6);
  text << "Hill's anisotropy (F " << coefficients.F << ", G " << coefficients.G << ", H " << coefficients.H
       << ", L " << coefficients.L << ", M " << coefficients.M << ", N " << coefficients.N << ")";
  if (!axes.are_global())
    text << " in " << axes.description();
  return text.str();
}

namespace {

/// Reads a list of positive numbers.
std::vector<double> read_positive(const TypeInput &input, const std::string &key, const std::size_t n,
                                  const std::string &allowed) {
  const std::vector<double> numbers = input.numbers(key);
  if (numbers.size() != n ||
      std::any_of(numbers.begin(), numbers.end(), [](const double number) { return !(number > 0.); }))
    input.reject(key, allowed);
  return numbers;
}

HillCoefficients read_coefficients(const TypeInput &input) {
  constexpr const char *r_values = "r-values", *stress_ratios = "Stress ratios";
  if (input.is_set(r_values) == input.is_set(stress_ratios))
    input.reject(r_values, input.is_set(r_values)
                               ? "no value, since 'Stress ratios' is set: give one of them"
                               : "three numbers > 0: r0, r45, r90; or set 'Stress ratios'");
  HillCoefficients coefficients;
  if (input.is_set(r_values)) {
    const auto r = read_positive(input, r_values, 3, "three numbers > 0: r0, r45, r90");
    coefficients = HillCoefficients::from_r_values(r[0], r[1], r[2]);
  } else {
    const auto given =
        read_positive(input, stress_ratios, 6, "six numbers > 0: R11, R22, R33, R12, R13, R23");
    std::array<double, 6> ratios{};
    std::copy(given.begin(), given.end(), ratios.begin());
    coefficients = HillCoefficients::from_stress_ratios(ratios);
  }
  if (!coefficients.is_convex())
    input.reject(stress_ratios, "six numbers whose yield surface is closed: no normal ratio may be far below "
                                "the others");
  return coefficients;
}

AnisotropyType hill_type() {
  using Kind = TypeParameter::Kind;
  AnisotropyType type{
      "Hill",
      "Hill's quadratic function of 1948, in axes that turn with the material",
      {{"r-values", "", Kind::text,
        "r0, r45, r90 > 0. Strain rates across over those through a sheet, in tension at 0, 45 and 90 "
        "degrees to the first of 'Axes'. The third of 'Axes' is the sheet's normal. The flow stress is that "
        "at 0 degrees."},
       {"Stress ratios", "", Kind::text,
        "R11, R22, R33, R12, R13, R23 > 0, in the place of r-values. Yield stresses in 'Axes' over the flow "
        "stress, those of shear over that of von Mises; 1, 1, 1, 1, 1, 1 is isotropic."}},
      [](const TypeInput &input) -> std::shared_ptr<const Anisotropy> {
        return std::make_shared<const Anisotropy>(Anisotropy{read_coefficients(input), Axes(input)});
      }};
  for (const TypeParameter &parameter : Axes::parameters())
    type.parameters.push_back(parameter);
  return type;
}

} // namespace

TypeTable<std::shared_ptr<const Anisotropy>> &anisotropy_types() {
  static TypeTable<std::shared_ptr<const Anisotropy>> types{
      {"none", "von Mises' function", {}, [](const TypeInput &) { return nullptr; }}, hill_type()};
  return types;
}

} // namespace billet
