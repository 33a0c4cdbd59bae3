// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/volumetric_law.h"

namespace billet {

VolumetricLawType logarithmic_volume_type();
VolumetricLawType quadratic_volume_type();
VolumetricLawType ogden_volume_type();

TypeTable<SharedVolumetricLaw> &volumetric_law_types() {
  static TypeTable<SharedVolumetricLaw> types = {
      logarithmic_volume_type(),
      quadratic_volume_type(),
      ogden_volume_type(),
  };
  return types;
}

} // namespace billet
