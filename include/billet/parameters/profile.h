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

/// A parameter that the scene leaves open, and what a profile or the target error makes of it.
struct Preset {
  SceneFile::Path path;
  std::string key, value;
};

/// Declares 'Profile' and 'Target error' at the top level.
void declare_presets(dealii::ParameterHandler &prm);

/// Gives the parameters that `file` leaves open the values of the profile or of the target error that it asks
/// for, in `prm`, and tells which. Before prm is read; values that the file sets stay. Throws InputError.
std::vector<Preset> apply_presets(dealii::ParameterHandler &prm, const SceneFile &file);

/// What 'Target error' says, such as '1 percent', '1 %' or '0.01', as a part of one; 0: nothing. Throws
/// InputError.
double read_target_error(const SceneFile &file);

/// "Time stepping / Maximum step = 0.2".
std::string to_string(const Preset &preset);

} // namespace billet::parameters

#endif
