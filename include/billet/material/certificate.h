// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_CERTIFICATE_H
#define BILLET_MATERIAL_CERTIFICATE_H

#include "billet/material/point_law.h"

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Result of one trial of a law.
struct Finding {
  enum class Verdict { passed, failed, reported };

  std::string property; ///< such as "objectivity"
  double value = 0.;    ///< largest error or the measure
  double allowed = 0.;  ///< limit of the value; 0 if it is only reported
  std::string remark;   ///< what was done, or where it fails
  Verdict verdict = Verdict::reported;

  /// Makes a finding that passes if the value is a number up to the limit.
  static Finding judge(std::string property, double value, double allowed, std::string remark);
};

/// Range of stretches on a straight path in which the law has a stress and is elliptic.
struct SafeRange {
  std::string mode; ///< such as "uniaxial"
  double minimum = 1., maximum = 1.;
  bool is_open_below = false, is_open_above = false; ///< whether the trial ended before the law did
};

struct Certificate {
  std::string law;
  std::vector<Finding> findings;
  std::vector<SafeRange> ranges;
  double seconds = 0.;

  bool has_passed() const;
};

/// The same material, with the numbers of its parameters in other units. Factors: numbers in these
/// units over those in the first ones.
struct OtherUnits {
  std::shared_ptr<const PointLaw> law; ///< null if it is not known
  std::string why_not;                 ///< then
  double stress = 1., time = 1., temperature = 1.;
};

/// Settings of the paths along which a law is driven.
struct CertificationSettings {
  double dt = 1e-3;            ///< length of each step [time]
  double temperature = 0.;     ///< of the body
  unsigned int n_paths = 1000; ///< of the comparison of tangents
  std::optional<OtherUnits> other_units = {};
};

/// Drives a law through what a run demands of it, and judges it. It takes some seconds. The checks
/// are:
///   objectivity        rotations of the body turn the stress
///   tangent            moduli against differences along random paths: loading, unloading,
///                      reversal, shear
///   symmetry           of the moduli, if the law says so
///   dissipation        the work less the stored energy does not fall; energies and work balance
///   steps              from 1e-6 to 0.5 of strain: a finite stress that converges with the step
///   repeated stretches no drift of the stress in elastic cycles
///   units              if its parameters' units are known, the stress does not depend on them
///   checkpoint         the state of a point has all that the next steps need
///   ellipticity        ranges of stretches, (U8)
///   cost               an update beside Hencky's law with J2 plasticity
Certificate certify(const PointLaw &law, const CertificationSettings &settings);

} // namespace billet

#endif
