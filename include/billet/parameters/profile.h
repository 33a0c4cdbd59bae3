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

/// Declares 'Profile', 'Target error' and what belongs to it at the top level.
void declare_presets(dealii::ParameterHandler &prm);

/// Gives the parameters in `prm` that `file` does not set the values of its profile or target
/// error. Returns these parameters. `generated_pairs`: names of the contact pairs that the scene
/// itself does not have. Call it before prm is read. Throws InputError.
std::vector<Preset> apply_presets(dealii::ParameterHandler &prm, const SceneFile &file,
                                  const std::vector<std::string> &generated_pairs);

/// Returns the part of 'Target error' that is left to sources other than the mesh, as a fraction.
/// The entry may be '1 percent', '1 %' or '0.01'. The part is all of it with the mesh as given,
/// else a third. It is 0 if the entry is not set. Throws InputError.
double read_target_error(const SceneFile &file);

/// Part of the target error that is left to the mesh.
struct MeshTarget {
  double error = 0.;             ///< relative to the forces; 0: the mesh stays as given
  unsigned int finest_level = 0; ///< most refinements of the given mesh

  bool is_wanted() const { return error > 0.; }
};
/// Reads the mesh's part. Throws InputError.
MeshTarget read_mesh_target(const SceneFile &file);

/// Returns "Time stepping / Maximum step = 0.2".
std::string to_string(const Preset &preset);

} // namespace billet::parameters

#endif
