// SPDX-License-Identifier: LGPL-2.1-or-later
// An elastic law that the library does not know, with a volumetric part of its own, registered here and named
// by a scene: uniaxial tension with every element and scheme against the closed form; the tangent by the
// number of Newton iterations.

#include "pulled_cube.h"

#include "billet/material/elasticity.h"
#include "billet/material/flow_rule.h"
#include "billet/material/hardening.h"
#include "billet/material/law_adapter.h"
#include "billet/material/neo_hookean.h"

namespace added_elasticity_test {

using namespace billet;
using billet::testing::check;

namespace {

/// ψ = ½ κ (J − 1)² + ½ G (tr b̄ − 3).
class QuadraticVolumeElasticity {
public:
  struct History {};
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = false, is_rate_form = false, has_symmetric_moduli = true,
                        has_exact_dissipation = true;

  explicit QuadraticVolumeElasticity(const ElasticModuli &elastic) : elastic_(elastic) {}

  bool update(const dealii::Tensor<2, 3> &F, const History &, History &, dealii::SymmetricTensor<2, 3> &tau,
              SpatialModuli *moduli, const PointStep & = {}) const {
    IsochoricState state;
    if (!compute_isochoric_state(F, dealii::unit_symmetric_tensor<3>(), state))
      return false;
    const double J = state.J, pressure = elastic_.bulk * J * (J - 1.),
                 slope = elastic_.bulk * J * (2. * J - 1.);
    tau = elastic_.shear * state.deviator + pressure * dealii::unit_symmetric_tensor<3>();
    if (moduli != nullptr) {
      compute_neo_hookean_moduli({0., elastic_.shear}, state, 1., {}, *moduli);
      for (unsigned int i = 0; i < 6; ++i)
        for (unsigned int j = 0; j < 6; ++j)
          (*moduli)[i][j] += (i < 3 && j < 3 ? slope : 0.) - (i == j ? (i < 3 ? 2. : 1.) * pressure : 0.);
    }
    return true;
  }
  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &) const {
    IsochoricState state;
    if (!compute_isochoric_state(F, dealii::unit_symmetric_tensor<3>(), state))
      return 0.;
    return compute_elastic_energy({0., elastic_.shear}, state) +
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

SharedLaw make_law(const ElasticModuli &moduli, SharedFlow flow) {
  if (flow != nullptr)
    return nullptr;
  return std::make_shared<const LawAdapter<QuadraticVolumeElasticity>>("quadratic volume",
                                                                       QuadraticVolumeElasticity(moduli));
}

std::string material(const double poisson) {
  return "set Law = elastic\nset Elasticity = quadratic volume\nset Young modulus = 200e3\nset Poisson ratio "
         "= " +
         std::to_string(poisson);
}

/// Returns the message that refuses an anisotropy with this elasticity; "" if it is accepted.
std::string refusal_of_anisotropy(const std::string &elasticity) {
  std::ofstream("anisotropic.prm") << R"(
subsection Bodies
  subsection cube
    subsection Material
      set Young modulus = 200e3
      set Yield stress = 300
      set Anisotropy = Hill
      set r-values = 2, 1, 1
      set Elasticity = )" << elasticity
                                   << "\n    end\n  end\nend\n";
  try {
    parameters::Scene::read("anisotropic.prm");
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

/// Flow rules are refused with an elasticity that takes none; the message names those that do, with an added
/// one.
void check_flow_rules() {
  elasticity_types().add(
      isotropic_elasticity_type("another Hencky", "Hencky's, once more", &make_hencky_law, &make_hencky_law));
  const std::string choices = "choose 'Elasticity = Hencky' or 'Elasticity = another Hencky'";
  check("an elasticity without flow rules refuses them, and the added one is named",
        refusal_of_anisotropy("neo-Hookean").find(choices) != std::string::npos);
  check("the added one takes them",
        refusal_of_anisotropy("another Hencky").find("Anisotropy") == std::string::npos);
}

} // namespace

BILLET_MPI_TEST(added_elasticity) {
  elasticity_types().add(isotropic_elasticity_type("quadratic volume", "pressure linear in J", &make_law));
  const ElasticityType &type = *elasticity_types().find("quadratic volume");
  const ElasticModuli moduli{3., 1.};
  check("histories of it are found by two moduli, so that other laws can continue from it",
        type.find_law(moduli) != nullptr && type.find_law(moduli)->name() == "quadratic volume" &&
            type.find_law(moduli)->elastic().bulk == moduli.bulk);
  check("it has no plastic law", type.find_law(moduli, make_hardening(LinearHardening{1., 0.})) == nullptr);
  for (const std::string element : testing::all_element_names)
    for (const double poisson : {0.1, 0.4}) {
      const std::string name = element + ", Poisson ratio " + std::to_string(poisson).substr(0, 3);
      const double exact = testing::energy_of_tension(
          QuadraticVolumeElasticity(ElasticModuli::from_young_poisson(testing::cube_young, poisson)), 1.8);
      const auto found = testing::pull(element, material(poisson), 1.8, 1., 8);
      check(name + ", energy", std::abs(found.elastic / exact - 1.), 1e-9);
      check(name + ", at most seven Newton iterations a step", found.n_iterations <= 56);
      check(name + ", explicit",
            std::abs(testing::pull_explicitly(element, material(poisson), 1.8, 2e-4).elastic / exact - 1.),
            1e-2);
    }
  check_flow_rules();
}

} // namespace added_elasticity_test
