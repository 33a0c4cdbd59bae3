// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_comparison.h"

#include "billet/mechanics/assumed_strain_element.h"
#include "billet/mechanics/one_point.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

namespace billet {

ElementComparison::ElementComparison(std::shared_ptr<const PointLaw> law,
                                     const ElementFormulation &formulation)
    : elastic_(law->elastic()), formulation_(formulation), law_(std::move(law)), flow_(law_->flow_stress()) {}

double ElementComparison::equivalent_plastic_strain(const double elastic_deviatoric_energy) const {
  // G e:e = ½ 3G ε² with the equivalent strain ε.
  const double stiffness = 3. * elastic_.shear;
  const double strain = std::sqrt(2. * elastic_deviatoric_energy / stiffness);
  if (flow_ == nullptr || stiffness * strain <= flow_->stress(0.))
    return 0.;
  // Solve 3G (ε − α) = σ(α); the left side decreases faster than the right.
  double low = 0., high = strain;
  constexpr unsigned int n_bisections = 48;
  for (unsigned int i = 0; i < n_bisections; ++i) {
    const double middle = 0.5 * (low + high);
    (stiffness * (strain - middle) > flow_->stress(middle) ? low : high) = middle;
  }
  return low;
}

double ElementComparison::energy(const double volumetric_strain,
                                 const double elastic_deviatoric_energy) const {
  const double of_volume = 0.5 * elastic_.bulk * volumetric_strain * volumetric_strain;
  const double plastic_strain = equivalent_plastic_strain(elastic_deviatoric_energy);
  if (plastic_strain == 0.)
    return of_volume + elastic_deviatoric_energy;
  const double stiffness = 3. * elastic_.shear;
  const double elastic_strain = std::sqrt(2. * elastic_deviatoric_energy / stiffness) - plastic_strain;
  return of_volume + 0.5 * stiffness * elastic_strain * elastic_strain +
         flow_->plastic_work_at_rest(plastic_strain);
}

ElementComparison::Strains ElementComparison::measure(const dealii::Tensor<2, 3> &F) const {
  // C − I, without the cancellation error of C.
  dealii::Tensor<2, 3> H = F;
  for (unsigned int i = 0; i < 3; ++i)
    H[i][i] -= 1.;
  const auto squares =
      dealii::eigenvalues(dealii::symmetrize(H + dealii::transpose(H) + dealii::transpose(H) * H));
  std::array<double, 3> strains;
  double volumetric = 0.;
  for (unsigned int A = 0; A < 3; ++A)
    volumetric += strains[A] = 0.5 * std::log1p(squares[A]);
  double deviatoric = 0.;
  for (const double strain : strains)
    deviatoric += (strain - volumetric / 3.) * (strain - volumetric / 3.);
  return {volumetric, elastic_.shear * deviatoric};
}

bool ElementComparison::add_one_point(const ElementVectors &positions, const ElementVectors &displacements,
                                      ElementEnergies &energies) const {
  const OnePointElement element(elastic_, formulation_);
  OnePointElement::Reference reference;
  OnePointElement::Kinematics kinematics;
  if (!OnePointElement::initialize(positions, reference) ||
      !OnePointElement::compute(reference, displacements, kinematics))
    return false;
  Strains strains = measure(kinematics.F);
  const double of_centre = energy(strains);
  strains.deviatoric_energy += element.stabilise(reference, kinematics, {}).energy / reference.volume;
  const double whole = energy(strains);
  energies.used += reference.volume * whole;
  energies.hourglass += reference.volume * (whole - of_centre);
  energies.plastic += reference.volume * dissipation(strains);
  return true;
}

double ElementComparison::dissipation(const Strains &strains) const {
  const double plastic_strain = equivalent_plastic_strain(strains.deviatoric_energy);
  return plastic_strain > 0. ? flow_->plastic_work_at_rest(plastic_strain) : 0.;
}

double
ElementComparison::dissipation_between(const std::array<dealii::Tensor<2, 3>, n_element_points> &F) const {
  constexpr unsigned int n_within = 3; // points in each direction
  static const dealii::QGauss<3> within(n_within);
  double mean = 0.;
  for (unsigned int p = 0; p < within.size(); ++p) {
    dealii::Tensor<2, 3> there;
    for (unsigned int q = 0; q < n_element_points; ++q) {
      double share = 1.;
      for (unsigned int i = 0; i < 3; ++i)
        share *=
            0.5 * (1. + (((q >> i) & 1U) != 0U ? 1. : -1.) * std::sqrt(3.) * (2. * within.point(p)[i] - 1.));
      there += share * F[q];
    }
    mean += within.weight(p) * dissipation(measure(there));
  }
  return mean;
}

double ElementComparison::energy_of_taper(const ElementVectors &positions,
                                          const ElementVectors &displacements) const {
  using dealii::Tensor;
  ElementVectors moved = positions;
  for (unsigned int i = 0; i < n_element_dofs; ++i)
    moved[i] += displacements[i];
  const ModalGeometry reference(positions);
  const auto modes = compute_modes(moved);
  // Mean strain; in tapered bricks it differs from that at the centre by parts of the bending.
  Tensor<2, 3> jacobian, moved_jacobian;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) {
      jacobian[i][j] = reference.modes[j][i];
      for (unsigned int m = 0; m < n_linear_modes; ++m)
        moved_jacobian[i][j] += reference.beta[m][j] * modes[m][i];
    }
  const Tensor<2, 3> F = moved_jacobian * invert(jacobian);
  const auto strain = 0.5 * symmetrize(transpose(F) * F - dealii::unit_symmetric_tensor<3>());
  const double shear = elastic_.shear, lame = elastic_.bulk - 2. / 3. * shear,
               young = 9. * elastic_.bulk * shear / (3. * elastic_.bulk + shear);
  const Tensor<2, 3> back = invert(F);
  double energy = 0.;
  for (unsigned int i = 0; i < 3; ++i)     // direction along which the brick bends
    for (unsigned int j = 0; j < 3; ++j) { // direction through its thickness
      if (i == j)
        continue;
      const unsigned int k = 3 - i - j, between = 3 + k;
      const double length = reference.modes[i].norm(), thickness = reference.modes[j].norm(),
                   width = reference.modes[k].norm();
      const Tensor<1, 3> along = reference.modes[i] / length, through = reference.modes[j] / thickness,
                         across = reference.modes[k] / width;
      const double bending = (back * modes[between] - reference.modes[between]) * along / length;
      if (bending == 0.)
        continue;
      const auto tapered = [&](const unsigned int mode, const double other) {
        // Taper of a_i and other.
        return -bending * reference.modes[mode] * along / other * length / thickness;
      };
      const double wanted = tapered(between, thickness), sheared = tapered(3 + j, width);
      const double stress = lame * trace(strain) + 2. * shear * (through * (strain * through)),
                   shear_stress = 2. * shear * (across * (strain * through));
      const double locked = std::clamp(stress * wanted, 0., young * wanted * wanted) +
                            std::clamp(shear_stress * sheared, 0., shear * sheared * sheared);
      energy += 0.5 * reference.volume * locked * (1. + 3. * locked / (young * bending * bending));
    }
  return energy;
}

void ElementComparison::add_dissipation(const PointEnergies &points, ElementEnergies &energies) const {
  if (flow_ == nullptr)
    return;
  double volume_of_all = 0.;
  for (unsigned int q = 0; q < n_element_points; ++q) {
    volume_of_all += points.volumes[q];
    energies.plastic += points.volumes[q] * dissipation(points.strains[q]);
  }
  energies.plastic_within += volume_of_all * dissipation_between(points.F);
}

void ElementComparison::compare_faces(const PointEnergies &points, ElementEnergies &energies) const {
  if (flow_ == nullptr || formulation_.points_through != AssumedStrainElement<>::points_through)
    return;
  const auto stress = [&](const Strains &strains) { // of an elastic body, von Mises
    return std::sqrt(6. * elastic_.shear * strains.deviatoric_energy);
  };
  const double yield_stress = flow_->stress(0.);
  if (std::any_of(points.strains.begin(), points.strains.end(),
                  [&](const Strains &strains) { return stress(strains) > yield_stress; }))
    return;
  double largest = 0.;
  for (unsigned int k = 0; k < 3; ++k)
    for (const double side : {-1., 1.}) {
      dealii::Tensor<2, 3> F;
      for (unsigned int q = 0; q < n_element_points; ++q)
        F += 0.125 * (1. + side * std::sqrt(3.) * corner(q, k)) * points.F[q];
      largest = std::max(largest, stress(measure(F)) / yield_stress);
    }
  if (largest > 1. + yield_margin) {
    energies.beyond_yield += energies.used;
    energies.face_stress = std::max(energies.face_stress, largest);
  }
}

bool ElementComparison::compare(const ElementVectors &positions, const ElementVectors &displacements,
                                ElementEnergies &energies) const {
  ElementEnergies own, one_point;
  PointEnergies accurate;
  if (!add_one_point(positions, displacements, one_point) ||
      !compute<AssumedStrainElement<>>(positions, displacements, accurate))
    return false;
  own.accurate = accurate.energy;
  // The energy of the taper is reduced in the same ratio where the body yields.
  own.tapered = accurate.elastic > 0.
                    ? own.accurate * energy_of_taper(positions, displacements) / accurate.elastic
                    : 0.;
  own.one_point = one_point.used;
  if (const auto compare = formulation_.element.comparison()) {
    if (!compare(*this, {positions, displacements, accurate, one_point}, own))
      return false;
  } else
    own.used = own.accurate;
  compare_faces(accurate, own);
  if (!std::isfinite(own.used + own.one_point + own.accurate + own.tapered + own.plastic_within))
    return false;
  energies += own;
  return true;
}

} // namespace billet
