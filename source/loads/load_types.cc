// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/node_site.h"
#include "billet/vector_text.h"

namespace billet {

LoadType acceleration_type();
LoadType pressure_type();
LoadType spring_type();
LoadType dashpot_type();
LoadType dead_traction_type();
LoadType body_force_type();
LoadType force_type();
LoadType moment_type();
LoadType rigid_face_type();

TypeTable<Load> &load_types() {
  static TypeTable<Load> types{acceleration_type(), pressure_type(),      spring_type(),
                               dashpot_type(),      dead_traction_type(), body_force_type(),
                               force_type(),        moment_type(),        rigid_face_type()};
  return types;
}

TypeParameter loaded_faces() {
  return {"Boundary ids", "", TypeParameter::Kind::text, "Boundary ids of the faces, separated by commas."};
}

TypeParameter loaded_nodes() {
  return {"Nodes", "", TypeParameter::Kind::text,
          "Nodes that bear the load in equal parts, in place of faces, as in supports. 'at x, y, z ; on line "
          "x, y, z : x, y, z ; set NAME' has all three forms."};
}

std::vector<TypeParameter> with_axes(std::vector<TypeParameter> parameters) {
  for (const TypeParameter &parameter : Axes::parameters())
    parameters.push_back(parameter);
  return parameters;
}

void add_vector_expressions(const TypeInput &input, const std::string &key, const bool uses_position,
                            Load &load) {
  for (const std::string &component : read_expressions(input, key))
    load.expressions.push_back({key, component, uses_position});
}

const LoadAction &Load::properties() const {
  return std::visit([](const auto &kind) -> const LoadAction & { return *kind; }, action);
}

bool Load::has_unsymmetric_tangent() const { return properties().tangent() == LoadTangent::unsymmetric; }

bool Load::acts_on_mass() const {
  const auto *body = std::get_if<std::shared_ptr<const BodyLoad>>(&action);
  return body != nullptr && !(*body)->is_per_volume();
}

std::vector<dealii::Tensor<1, 3>> Load::supports(const dealii::Tensor<1, 3> &normal) const {
  return properties().supports(normal);
}

bool Load::limits_steps() const {
  LoadedSurface unit;
  unit.stiffness = 1.;
  const LoadAction::Bound bound = properties().bound(unit);
  return bound.stiffness > 0. || bound.damping > 0.;
}

bool Load::is_viscous() const { return properties().bound(LoadedSurface()).damping > 0.; }

} // namespace billet
