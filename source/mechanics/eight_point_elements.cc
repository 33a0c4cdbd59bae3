// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/eight_point_elements.h"

#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

PointStresses MeanDilatationElement::weigh(const Reference &reference, const Kinematics &kinematics,
                                           const PointStresses &tau) {
  PointStresses weighed = tau;
  for (unsigned int q = 0; q < n_points; ++q) {
    const double ratio = kinematics.current_volumes[q] / reference.volumes[q] / kinematics.volume_ratio;
    weighed[q] += (ratio - 1.) * dealii::deviator(tau[q]);
  }
  return weighed;
}

void MeanDilatationElement::compute_rate_tangent(const Reference &reference, const Kinematics &kinematics,
                                                 const PointStresses &tau,
                                                 const PointModuli<GradientModuli> &moduli,
                                                 ElementMatrix &matrix) const {
  matrix.fill(0.);
  const ElementVectors &mean = kinematics.mean_divergence;
  double reference_volume = 0., volumetric = 0.; // V, Π
  for (unsigned int q = 0; q < n_points; ++q) {
    reference_volume += reference.volumes[q];
    volumetric += reference.volumes[q] * dealii::trace(tau[q]) / 3.;
  }
  // Pressure that gives Π J w [tr δL tr L − tr(δL L)]/v with the weights J w/J̄.
  const double pressure = volumetric * kinematics.volume_ratio / kinematics.current_volume;
  for (unsigned int q = 0; q < n_points; ++q) {
    const auto &g = kinematics.gradients[q];
    SymmetricTensor<2, 3> s = dealii::deviator(tau[q]);
    auto rates = multiply_gradients(moduli[q], g);
    for (unsigned int r = 0; r < 6; ++r)
      for (unsigned int k = 0; k < n_element_dofs; ++k)
        rates[r][k] +=
            s.access_raw_entry(r) * (g[k / 3][k % 3] - mean[k]) + (r < 3 ? pressure * g[k / 3][k % 3] : 0.);
    s += pressure * dealii::unit_symmetric_tensor<3>();
    add_point_tangent(kinematics.current_volumes[q] / kinematics.volume_ratio, g, s, rates, matrix.data(),
                      n_element_dofs);
  }
  const double factor = moduli[0].volumetric * reference_volume - volumetric;
  for (std::size_t r = 0; r < n_element_dofs; ++r)
    for (std::size_t c = 0; c < n_element_dofs; ++c)
      matrix[r * n_element_dofs + c] += factor * mean[r] * mean[c];
}

} // namespace billet
