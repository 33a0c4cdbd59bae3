// SPDX-License-Identifier: LGPL-2.1-or-later
// A block of many bricks in plane strain is pressed between plates without friction, and its side is free.
// The affine solution is exact on any mesh. The tangent has no negative eigenvalue before the continuum's,
// in the closed form of Biot (1965) for elastic blocks and of Hill & Hutchinson (J. Mech. Phys. Solids 23,
// 1975) for plastic ones, too: regular meshes, and nodes moved by 1e-6 to 0.2 of an edge.

#include "elements.h"

#include <deal.II/lac/lapack_full_matrix.h>

#include <complex>

namespace block_stability_test {

using namespace billet;
using namespace billet::testing;

namespace {

constexpr double bulk_over_shear = 5e3; // the closed form is incompressible
constexpr double yield_stress = 300., modulus = 1000.;

MaterialLaw elastic_law() {
  MaterialLaw law{steel, {}};
  law.elastic.bulk = bulk_over_shear * law.elastic.shear;
  return law;
}
MaterialLaw plastic_law() {
  MaterialLaw law = elastic_law();
  law.hardening = LinearHardening{yield_stress, modulus};
  return law;
}

Tensor<2, 3> press(const double across, const double pressed) {
  Tensor<2, 3> F = unit;
  F[0][0] = across;
  F[2][2] = pressed;
  return F;
}

/// The neo-Hookean stretch across, under the one along z, where the side is free.
double elastic_stretch(const double pressed) {
  // τ_xx = κ ln J + G J^{-2/3} (x² − tr b/3) = 0, by bisection.
  const auto stress = [pressed](const double x) {
    const double J = x * pressed;
    return bulk_over_shear * std::log(J) +
           std::pow(J, -2. / 3.) * (x * x - (x * x + 1. + pressed * pressed) / 3.);
  };
  double low = 0.5 / pressed, high = 2. / pressed;
  for (unsigned int i = 0; i < 100; ++i)
    (stress(0.5 * (low + high)) < 0. ? low : high) = 0.5 * (low + high);
  return low;
}

/// σ_z of the plastic block, elastic at first.
double plastic_stress(const double pressed) {
  const double shear = steel.shear, strain = -std::log(pressed),
               flow = std::max(0., (2. / std::sqrt(3.) * strain - yield_stress / (3. * shear)) /
                                       (1. + modulus / (3. * shear)));
  return -std::min(4. * shear * strain, 2. / std::sqrt(3.) * (yield_stress + modulus * flow));
}
double plastic_stretch(const double pressed) {
  return std::exp(0.5 * plastic_stress(pressed) / (bulk_over_shear * steel.shear)) / pressed;
}

/// Moduli of the continuum: in plane strain the rates of σ_z − σ_x and of σ_xz are 4 μ* d_z and 2 μ d_xz.
struct Moduli {
  double shear, stretch, stress; ///< μ, μ*, σ_z
};
Moduli elastic_moduli(const double pressed) {
  const double along = pressed * pressed, across = 1. / along;
  return {0.5 * (along + across), 0.5 * (along + across), along - across}; // over G
}
Moduli plastic_moduli(const double pressed) {
  return {steel.shear, 0.25 / (0.25 / steel.shear + 0.75 / modulus), plastic_stress(pressed)};
}

/// Changes its sign where the continuum becomes unstable with `waves` half waves along z, symmetric about
/// x = 0. ψ = f(x) cos kz is a stream function of velocities in equilibrium where
///     (μ − σ/2) f⁗ − 2 (2 μ* − μ) k² f″ + (μ + σ/2) k⁴ f = 0,
/// so that f is a sum of two sinh r_i kx. At the free side, x = a,
///     f″ + k² f = 0,    (μ − σ/2) (f‴ + k² f′) − (4 μ* − σ) k² f′ = 0.
double stability(const Moduli &moduli, const double pressed, const unsigned int waves) {
  using Number = std::complex<double>;
  const double a = moduli.shear - 0.5 * moduli.stress, c = moduli.shear + 0.5 * moduli.stress,
               b = 2. * moduli.stretch - moduli.shear;
  const double ka = waves * dealii::numbers::PI / (pressed * pressed); // width 1/λ_z, height λ_z
  const Number root = std::sqrt(Number(b * b - a * c));
  std::array<Number, 2> r, normal, tangential;
  for (unsigned int i = 0; i < 2; ++i) {
    const Number square = (b + (i == 0 ? 1. : -1.) * root) / a;
    r[i] = std::sqrt(square);
    normal[i] = (square + 1.) * std::tanh(r[i] * ka);
    tangential[i] = r[i] * (a * (square + 1.) - (4. * moduli.stretch - moduli.stress));
  }
  return ((normal[0] * tangential[1] - normal[1] * tangential[0]) / (r[0] - r[1])).real();
}

template <class ModuliOf>
double continuum_instability(const ModuliOf &moduli_of, const unsigned int max_waves) {
  double first = 0.;
  constexpr double step = 1e-4;
  constexpr unsigned int n_steps = 8000;
  for (unsigned int waves = 1; waves <= max_waves; ++waves)
    for (unsigned int i = 100; i < n_steps; ++i) {
      const double before = 1. - step * (i - 1), pressed = 1. - step * i;
      if (stability(moduli_of(before), before, waves) * stability(moduli_of(pressed), pressed, waves) <= 0.) {
        first = std::max(first, pressed);
        break;
      }
    }
  return first;
}

/// A square of n x n bricks, half of the block: x = 0 and the plates do not move across.
class Block {
public:
  /// Inner nodes are moved at random by up to `moved` of an edge.
  Block(const MaterialLaw &law, const LawFormulation &formulation, const unsigned int n, const double moved)
      : n_(n) {
    Random random;
    std::map<std::pair<unsigned int, unsigned int>, Tensor<1, 3>> places;
    for (unsigned int i = 0; i <= n; ++i)
      for (unsigned int j = 0; j <= n; ++j) {
        Tensor<1, 3> place({double(i), 0., double(j)});
        if (i > 0 && i < n && j > 0 && j < n)
          for (const unsigned int k : {0U, 2U})
            place[k] += random(-moved, moved);
        places[{i, j}] = place / n;
      }
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j) {
        NodalTensor X;
        for (unsigned int a = 0; a < n_element_nodes; ++a) {
          Tensor<1, 3> place = places.at({i + (a & 1U), j + (a >> 2U)});
          place[1] = double((a >> 1U) & 1U) / n;
          for (unsigned int k = 0; k < 3; ++k)
            X[3 * a + k] = place[k];
        }
        positions_.push_back(X);
        elements_.push_back(make_block(law, X, formulation));
      }
  }

  /// This state becomes the history.
  void commit(const Tensor<2, 3> &F) {
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      compute_force(*elements_[e], displace(F, positions_[e]));
      elements_[e]->commit();
    }
  }

  /// Eigenvalues of the symmetric part of the tangent.
  unsigned int n_negative(const Tensor<2, 3> &F) {
    constexpr unsigned int held = dealii::numbers::invalid_unsigned_int;
    std::map<std::array<unsigned int, 3>, unsigned int> dofs; // of a node at (i, j) in x and z
    const auto dof = [&](const unsigned int i, const unsigned int j, const unsigned int component) {
      const bool is_held =
          component == 1 || (component == 0 && i == 0) || (component == 2 && (j == 0 || j == n_));
      return is_held ? held
                     : dofs.emplace(std::array<unsigned int, 3>{i, j, component},
                                    static_cast<unsigned int>(dofs.size()))
                           .first->second;
    };
    dealii::LAPACKFullMatrix<double> matrix(n_ * (n_ + 1) + (n_ + 1) * (n_ - 1));
    for (unsigned int i = 0; i < n_; ++i)
      for (unsigned int j = 0; j < n_; ++j) {
        const std::size_t e = i * n_ + j;
        ElementMatrix K;
        compute_force(*elements_[e], displace(F, positions_[e]), &K);
        std::array<unsigned int, n_element_dofs> of_element{};
        for (unsigned int a = 0; a < n_element_nodes; ++a)
          for (unsigned int c = 0; c < 3; ++c)
            of_element[3 * a + c] = dof(i + (a & 1U), j + (a >> 2U), c);
        for (unsigned int r = 0; r < n_element_dofs; ++r)
          for (unsigned int c = 0; c < n_element_dofs; ++c)
            if (of_element[r] != held && of_element[c] != held)
              matrix(of_element[r], of_element[c]) +=
                  0.5 * (K[r * n_element_dofs + c] + K[c * n_element_dofs + r]);
      }
    dealii::FullMatrix<double> vectors;
    dealii::Vector<double> negative;
    matrix.compute_eigenvalues_symmetric(-1e300, 0., 0., negative, vectors);
    return negative.size();
  }

private:
  unsigned int n_;
  std::vector<NodalTensor> positions_;
  std::vector<std::unique_ptr<ElementBlock>> elements_;
};

/// The stretch at which the first negative eigenvalue of an elastic block appears; 0 if none does.
double first_instability(const LawFormulation &formulation, const unsigned int n, const double moved) {
  Block block(elastic_law(), formulation, n, moved);
  const auto is_unstable = [&](const double pressed) {
    return block.n_negative(press(elastic_stretch(pressed), pressed)) > 0;
  };
  double stable = 1., unstable = 0.2;
  if (!is_unstable(unstable))
    return 0.;
  while (stable - unstable > 1e-3) {
    const double middle = 0.5 * (stable + unstable);
    (is_unstable(middle) ? unstable : stable) = middle;
  }
  return unstable;
}

std::string moved_by(const double moved) {
  std::ostringstream text;
  text << ", nodes moved by " << moved << " of an edge";
  return text.str();
}

void check_elastic_blocks() {
  LawFormulation formulation;
  formulation.elasticity = neo_hookean;
  const double exact = continuum_instability(elastic_moduli, 8);
  check("a half space wrinkles at a stretch of 0.5437, a block a little later",
        exact > 0.542 && exact < 0.5437);
  for (const auto element : all_elements()) {
    formulation.element = element;
    const std::string name = element.name();
    const double coarse = first_instability(formulation, 8, 0.),
                 fine = first_instability(formulation, 16, 0.);
    check(name + ", an elastic block is not unstable before the continuum is",
          coarse < exact && fine < exact);
    check(name + ", but then, and the finer the nearer", coarse < fine && fine > 0.97 * exact);
    for (const double moved : {1e-6, 0.05, 0.2}) {
      const double distorted = first_instability(formulation, 8, moved);
      check(name + moved_by(moved) + ": not before the continuum, either",
            distorted > 0.8 * exact && distorted < exact);
    }
  }
}

void check_plastic_blocks() {
  LawFormulation formulation;
  formulation.elasticity = hencky;
  constexpr unsigned int n = 8;
  constexpr double step = 0.005, tangent_step = 1e-6, lowest = 0.25;
  check("a plastic continuum is stable to a quarter of its height",
        continuum_instability(plastic_moduli, n) < lowest);
  for (const auto element : all_elements())
    for (const double moved : {0., 1e-6, 0.05, 0.2}) {
      formulation.element = element;
      Block block(plastic_law(), formulation, n, moved);
      unsigned int n_negative = 0;
      for (unsigned int i = 1; 1. - step * i >= lowest; ++i) {
        const double pressed = 1. - step * i, further = pressed * (1. - tangent_step);
        block.commit(press(plastic_stretch(pressed), pressed));
        if (i % 25 == 0)
          n_negative += block.n_negative(press(plastic_stretch(further), further));
      }
      check(std::string(element.name()) + ", plastic" + moved_by(moved) + ": so is the block",
            n_negative == 0);
    }
}

} // namespace

BILLET_TEST(block_stability) {
  check_elastic_blocks();
  check_plastic_blocks();
}

} // namespace block_stability_test
