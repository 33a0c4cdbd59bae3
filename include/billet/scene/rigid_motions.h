// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_RIGID_MOTIONS_H
#define BILLET_SCENE_RIGID_MOTIONS_H

#include <deal.II/base/tensor.h>

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// A point of a body where something resists its motion along a direction.
struct Resistance {
  enum class Sense {
    both_ways, ///< a support, a symmetry plane, friction
    push,      ///< against the direction only: contact pushes, but does not pull
    force_push ///< the same by a tool that gives way, since it presses with a force
  };
  dealii::Tensor<1, 3> position;  ///< [length]
  dealii::Tensor<1, 3> direction; ///< unit; of contact the tool's normal
  Sense sense;
};

/// Adds what a tool does where it touches a body: it pushes along its `normal`, and with friction holds
/// across it.
void add_contact(const dealii::Tensor<1, 3> &position, const dealii::Tensor<1, 3> &normal,
                 bool presses_with_force, bool has_friction, std::vector<Resistance> &resistances);

/// An infinitesimal motion of a rigid body, up to a factor: x moves by translation + rotation × (x − centre)
/// / size.
struct RigidMotion {
  dealii::Tensor<1, 3> translation, rotation;
};
/// "translation (x, y, z) and rotation (x, y, z)", for messages.
std::string print(const RigidMotion &motion);

/// A rigid motion of a body of that `centre` and `size` [length] that nothing resists, if there is one: no
/// resistance at all; or one direction only, where contact does not push; or none but of tools that press
/// with forces, which hold a body against something else, not between themselves.
std::optional<RigidMotion> find_free_motion(const std::vector<Resistance> &resistances,
                                            const dealii::Tensor<1, 3> &centre, double size);

} // namespace billet

#endif
