// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/load.h"

namespace billet {

LoadType acceleration_type();
LoadType pressure_type();
LoadType spring_type();
LoadType dashpot_type();

TypeTable<Load> &load_types() {
  static TypeTable<Load> types{acceleration_type(), pressure_type(), spring_type(), dashpot_type()};
  return types;
}

TypeParameter loaded_faces() {
  return {"Boundary ids", "", TypeParameter::Kind::text, "Boundary ids of the faces, separated by commas."};
}

bool Load::has_unsymmetric_tangent() const {
  if (const auto *face = std::get_if<std::shared_ptr<const FaceLoad>>(&action))
    return (*face)->tangent() == LoadTangent::unsymmetric;
  if (const auto *node = std::get_if<std::shared_ptr<const NodalLoad>>(&action))
    return (*node)->tangent() == LoadTangent::unsymmetric;
  return false;
}

bool Load::limits_steps() const {
  const auto *node = std::get_if<std::shared_ptr<const NodalLoad>>(&action);
  if (node == nullptr)
    return false;
  const NodalLoad::Bound bound = (*node)->bound();
  return bound.stiffness > 0. || bound.damping > 0.;
}

} // namespace billet
