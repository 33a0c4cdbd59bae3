// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_PROFILE_H
#define BILLET_PARAMETERS_PROFILE_H

#include "billet/parameters/scene_file.h"

#include <string>
#include <vector>

namespace dealii {
class ParameterHandler;
}

namespace billet::parameters {

/// Parameter that the scene does not set, with the value from the profile or the target error.
struct Preset {
  SceneFile::Path path;
  std::string key, value;
};

/// Declares 'Profile' and 'Target error' at the top level.
void declare_presets(dealii::ParameterHandler &prm);

/// Gives the parameters in `prm` that `file` does not set the values of its profile or target error. Returns
/// these parameters. Call it before prm is read. Throws InputError.
std::vector<Preset> apply_presets(dealii::ParameterHandler &prm, const SceneFile &file);

/// Returns the value of 'Target error', such as '1 percent', '1 %' or '0.01', as a fraction; 0 if it is not
/// set. Throws InputError.
double read_target_error(const SceneFile &file);

/// Returns "Time stepping / Maximum step = 0.2".
std::string to_string(const Preset &preset);

} // namespace billet::parameters

#endif
