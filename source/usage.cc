// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/usage.h"

namespace billet {

std::array<Usage::Entry, static_cast<std::size_t>(Capability::n)> Usage::entries;

std::uint64_t ElementLoops::of_forces = 0, ElementLoops::of_tangents = 0;

const char *name_of(const Capability capability) {
  switch (capability) {
  case Capability::plasticity:
    return "Plasticity";
  case Capability::stabilisation:
    return "Hourglass";
  case Capability::contact:
    return "Contact";
  case Capability::friction:
    return "Friction";
  case Capability::body_contact:
    return "Body contact";
  case Capability::self_contact:
    return "Self-contact";
  case Capability::edges:
    return "Edges";
  case Capability::augmentation:
    return "Augmentation";
  case Capability::moving_supports:
    return "Moving support";
  case Capability::driven_tools:
    return "Driven tools";
  case Capability::loads:
    return "Loads";
  case Capability::inertia:
    return "Inertia";
  case Capability::error_control:
    return "Error control";
  case Capability::matrix:
    return "Matrix";
  case Capability::unsymmetric_matrix:
    return "Unsymmetric";
  case Capability::iterative_solver:
    return "Iterative";
  case Capability::checkpoints:
    return "Checkpoints";
  case Capability::n:
    break;
  }
  return "";
}

} // namespace billet
