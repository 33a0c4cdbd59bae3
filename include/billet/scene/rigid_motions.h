// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_RIGID_MOTIONS_H
#define BILLET_SCENE_RIGID_MOTIONS_H

#include <deal.II/base/tensor.h>

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Point of a body where a support or contact resists its motion along a direction.
struct Resistance {
  enum class Sense {
    both_ways, ///< a support, a symmetry plane, friction
    push,      ///< against the direction only: contact carries no tension
    force_push ///< same for a force-controlled tool, which yields
  };
  dealii::Tensor<1, 3> position;  ///< [length]
  dealii::Tensor<1, 3> direction; ///< unit; for contact the tool's normal
  Sense sense;
};

/// Adds the resistances of a tool at a contact point: one along its `normal` and, with friction,
/// two across it.
void add_contact(const dealii::Tensor<1, 3> &position, const dealii::Tensor<1, 3> &normal,
                 bool presses_with_force, bool has_friction, std::vector<Resistance> &resistances);

/// Infinitesimal rigid-body motion, up to a factor: x moves by translation +
/// rotation × (x − centre) / size.
struct RigidMotion {
  dealii::Tensor<1, 3> translation, rotation;
};
/// Returns "translation (x, y, z) and rotation (x, y, z)", for messages.
std::string print(const RigidMotion &motion);

/// Returns a free rigid-body mode of a body of this `centre` and `size` [length], if there is one.
/// A mode is free if no resistance acts on it, or if contact resists it only in the opposite
/// direction. It is also free if only force-controlled tools resist it: they press a body against
/// something else.
std::optional<RigidMotion> find_free_motion(const std::vector<Resistance> &resistances,
                                            const dealii::Tensor<1, 3> &centre, double size);

} // namespace billet

#endif
