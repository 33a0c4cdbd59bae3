// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_LAW_TRIALS_H
#define BILLET_MATERIAL_LAW_TRIALS_H

#include "billet/material/certificate.h"
#include "billet/material/law_point.h"

#include <random>

namespace billet {

/// Random numbers that are the same on every machine.
class TrialNumbers {
public:
  double operator()(const double low, const double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.;
  }
  /// Returns a number whose logarithm is uniform.
  double logarithmic(double low, double high);
  /// Returns a tensor of norm 1 in a random direction, nearly without a trace: real loads on metals
  /// are.
  dealii::SymmetricTensor<2, 3> strain();
  /// Returns a rotation by up to `angle`.
  dealii::Tensor<2, 3> rotation(double angle);

private:
  std::mt19937 engine_;
};

// The trials of certify(), one function for each. They find nothing if the law refuses all of their
// steps.

std::vector<Finding> try_objectivity(const PointLaw &law, const CertificationSettings &settings);
/// Tangent and symmetry.
std::vector<Finding> try_tangent(const PointLaw &law, const CertificationSettings &settings);
std::vector<Finding> try_energies(const PointLaw &law, const CertificationSettings &settings);
std::vector<Finding> try_steps(const PointLaw &law, const CertificationSettings &settings);
std::vector<Finding> try_repeated_stretches(const PointLaw &law, const CertificationSettings &settings);
/// Nothing if there are no other units.
std::vector<Finding> try_units(const PointLaw &law, const CertificationSettings &settings);
std::vector<Finding> try_checkpoint(const PointLaw &law, const CertificationSettings &settings);
std::vector<Finding> try_cost(const PointLaw &law, const CertificationSettings &settings);

/// Returns the smallest eigenvalue, over directions n and amplitudes m, of the acoustic tensor
///   Q m = δτ(m ⊗ n) n − (m · n) τ n                                                           (U8)
/// [stress]. For moduli of the Lie derivative it is (M7).
double min_acoustic_eigenvalue(const StressRates &rates, const dealii::SymmetricTensor<2, 3> &tau);
/// Ranges of the stretch in tension, equibiaxial tension, plane strain, simple shear and change of
/// volume.
std::vector<SafeRange> find_safe_ranges(const PointLaw &law, const CertificationSettings &settings);

} // namespace billet

#endif
