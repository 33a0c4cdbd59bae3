// SPDX-License-Identifier: LGPL-2.1-or-later
// Fung's law, whose shear stiffness grows or falls exponentially: explicit steps follow the moduli, and the
// loss of stability is told where it is lost.
#include "pulled_cube.h"

#include "billet/material/elasticity.h"
#include "billet/material/law_adapter.h"
#include "billet/material/neo_hookean.h"
#include "billet/solve/stability_watch.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace added_stiffening_test {

using namespace billet;
using billet::testing::check;

namespace {

/// ψ = ½ κ (J − 1)² + G/(2 c) (exp(c (tr b̄ − 3)) − 1).
template <int c> class Fung {
public:
  struct History {};
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = false, is_rate_form = false, has_symmetric_moduli = true,
                        has_exact_dissipation = true;

  explicit Fung(const ElasticModuli &elastic) : elastic_(elastic) {}

  bool update(const dealii::Tensor<2, 3> &F, const History &, History &, dealii::SymmetricTensor<2, 3> &tau,
              SpatialModuli *moduli, const PointStep & = {}) const {
    IsochoricState state;
    if (!compute_isochoric_state(F, dealii::unit_symmetric_tensor<3>(), state))
      return false;
    const double J = state.J, pressure = elastic_.bulk * J * (J - 1.),
                 shear = elastic_.shear * std::exp(3. * c * (state.mean - 1.));
    tau = shear * state.deviator + pressure * dealii::unit_symmetric_tensor<3>();
    if (moduli == nullptr)
      return true;
    compute_neo_hookean_moduli({0., shear}, state, 1., {}, *moduli);
    const auto deviator = [&](const unsigned int i) {
      return state.deviator[dealii::SymmetricTensor<2, 3>::unrolled_to_component_indices(i)];
    };
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        (*moduli)[i][j] += 2. * c * shear * deviator(i) * deviator(j) +
                           (i < 3 && j < 3 ? elastic_.bulk * J * (2. * J - 1.) : 0.) -
                           (i == j ? (i < 3 ? 2. : 1.) * pressure : 0.);
    return true;
  }
  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &) const {
    IsochoricState state;
    if (!compute_isochoric_state(F, dealii::unit_symmetric_tensor<3>(), state))
      return 0.;
    return 0.5 * elastic_.shear / c * std::expm1(3. * c * (state.mean - 1.)) +
           0.5 * elastic_.bulk * (state.J - 1.) * (state.J - 1.);
  }
  static double plastic_work(const History &) { return 0.; }
  static double equivalent_plastic_strain(const History &) { return 0.; }
  const ElasticModuli &elastic() const { return elastic_; }
  double min_wave_stiffness(const Stretches &stretches) const {
    return billet::min_wave_stiffness(*this, elastic_.shear, stretches);
  }

private:
  ElasticModuli elastic_;
};

using Stiffening = Fung<60>;
using Softening = Fung<-15>;

template <class Law> SharedLaw make_law(const ElasticModuli &moduli, SharedFlow flow) {
  return flow != nullptr ? nullptr : std::make_shared<const LawAdapter<Law>>("Fung", Law(moduli));
}

std::string material(const std::string &elasticity) {
  return "set Law = elastic\nset Elasticity = " + elasticity + "\nset Young modulus = 200e3";
}

/// Whether a cube of this elasticity is told to be unstable at this stretch along z, at its volume.
bool is_told_unstable(const std::string &elasticity, const double stretch) {
  const Scene scene(testing::read_pulled_cube("assumed strain", material(elasticity), stretch, 1., false, 1));
  const Discretization discretization(scene, MPI_COMM_WORLD);
  SolutionState state;
  state.displacements = discretization.make_ghosted_vector();
  Vector owned = discretization.make_owned_vector();
  for (const Element &element : discretization.elements(0)) {
    const ElementVectors x = nodal_positions(element.cell);
    for (unsigned int i = 0; i < n_element_dofs; ++i)
      owned[element.dofs[i]] = x[i] * ((i % 3 == 2 ? stretch : 1. / std::sqrt(stretch)) - 1.);
  }
  owned.compress(dealii::VectorOperation::insert);
  state.displacements = owned;
  return !StabilityWatch(scene, discretization).check(state).empty();
}

} // namespace

BILLET_MPI_TEST(added_stiffening) {
  elasticity_types().add(isotropic_elasticity_type("stiffening", "Fung's law", &make_law<Stiffening>));
  elasticity_types().add(isotropic_elasticity_type("softening", "Fung's law", &make_law<Softening>));

  const ElasticModuli moduli = ElasticModuli::from_young_poisson(testing::cube_young, testing::cube_poisson);
  for (const std::string element : testing::all_element_names) {
    const double exact = testing::energy_of_tension(Stiffening(moduli), 1.18);
    check(element + ", static",
          std::abs(testing::pull(element, material("stiffening"), 1.18, 1., 10).elastic / exact - 1.), 1e-9);
    check(
        element + ", explicit",
        std::abs(testing::pull_explicitly(element, material("stiffening"), 1.18, 2e-4).elastic / exact - 1.),
        1e-2);
  }
  for (const double stretch : {1.02, 1.25}) {
    const double across = 1. / std::sqrt(stretch);
    const bool is_unstable = Softening(moduli).min_wave_stiffness({stretch, across, across}) < 0.;
    check("softening at a stretch of " + std::to_string(stretch).substr(0, 4),
          is_unstable == (stretch > 1.2) && is_told_unstable("softening", stretch) == is_unstable);
  }
  check("stiffening never", !is_told_unstable("stiffening", 1.25));
}

} // namespace added_stiffening_test
