// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_FADING_NAMES_H
#define BILLET_SOLVE_FADING_NAMES_H

#include "billet/solve/restart.h"

#include <optional>
#include <string>
#include <vector>

namespace billet {

// Checkpoints name the supports and pairs whose forces fade. A scene that resumes may not have
// them; their index is then empty.

/// Saves the names of supports by their indices in named_supports(); nothing if there are none.
void save_fading_supports(StateWriter &writer, const Scene &scene,
                          const std::vector<std::optional<std::size_t>> &supports);
/// Returns these indices in the scene for `n` fading forces.
std::vector<std::optional<std::size_t>> load_fading_supports(const StateReader &reader, const Scene &scene,
                                                             std::size_t n);

/// Saves the names of the pairs with a removed tool, by their indices in Scene::pairs().
void save_fading_pairs(StateWriter &writer, const Scene &scene,
                       const std::vector<std::optional<std::size_t>> &pairs);
/// Fading forces of a removed tool in a checkpoint.
struct FadingPair {
  std::optional<std::size_t> pair; ///< index in Scene::pairs()
  std::string rows;                ///< name of the rows of its forces
};
std::vector<FadingPair> load_fading_pairs(const StateReader &reader, const Scene &scene);
/// Returns the name of the rows of forces at an index of save_fading_pairs().
std::string fading_rows(std::size_t index);

} // namespace billet

#endif
