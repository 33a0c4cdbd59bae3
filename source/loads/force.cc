// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/node_site.h"

namespace billet {

LoadType force_type();

namespace {

/// F_a = A_a/A F: the force is spread evenly over all faces. Its line of action passes through
/// their centroid.
class SpreadForce final : public DeadLoad<NodalLoad> {
public:
  explicit SpreadForce(const Axes &axes) : axes_(axes) {}

  void add_forces(const std::vector<LoadedNode> &nodes, const LoadValues &values,
                  const NodalMotion & /*motion*/, double *forces) const override {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const LoadedSurface &surface = *nodes[k].surface;
      add_vector(forces, nodes[k].node,
                 nodes[k].area / surface.area * axes_.to_global(values.at(k), surface.centre));
    }
  }

private:
  Axes axes_;
};

/// F_a = N_a(X) F, or F/n on each of n selected nodes.
class ConcentratedForce final : public PointLoad {
public:
  ConcentratedForce(const std::optional<dealii::Point<3>> &position, const bool takes_nearest_node,
                    const Axes &axes)
      : position_(position), takes_nearest_node_(takes_nearest_node), axes_(axes) {}

  std::optional<dealii::Point<3>> position() const override { return position_; }
  bool takes_nearest_node() const override { return takes_nearest_node_; }
  dealii::Tensor<1, 3> force(const double *values) const override {
    return axes_.to_global(values, position_.value_or(dealii::Point<3>()));
  }

private:
  std::optional<dealii::Point<3>> position_;
  bool takes_nearest_node_;
  Axes axes_;
};

Load make_force(const TypeInput &input) {
  const bool has_point = input.is_set("Point"), has_nodes = input.is_set("Nodes");
  const bool has_faces = input.is_set("Boundary ids");
  if (!has_point && !has_nodes && !has_faces)
    input.reject("Point", "a point 'x, y, z', 'Nodes' that share the force, or 'Boundary ids' of faces over "
                          "which the force is spread");
  if (has_faces && (has_point || has_nodes))
    input.reject("Boundary ids", std::string("no value: '") + (has_point ? "Point" : "Nodes") +
                                     "' says where the force acts");
  if (has_point && has_nodes)
    input.reject("Nodes", "no value: 'Point' says where the force acts");
  if (!has_point && input.is_set("Place"))
    input.reject("Place", "no value: 'Point' is not set");
  const Axes axes(input);
  if (axes.are_cylindrical() && !has_point)
    input.reject("Axes", std::string("global or local: a force on ") + (has_nodes ? "nodes" : "faces") +
                             " has one direction. 'Type = dead traction' takes cylindrical ones");
  if (axes.are_cylindrical() && !(axes.radius(input.vector("Point")) > 0.))
    input.reject("Point", "a point off the line of the cylindrical axes");
  Load load;
  if (has_point)
    load.action = std::make_shared<const ConcentratedForce>(dealii::Point<3>(input.vector("Point")),
                                                            input.text("Place") == "nearest node", axes);
  else if (has_nodes)
    load.action = std::make_shared<const ConcentratedForce>(std::nullopt, true, axes);
  else
    load.action = std::make_shared<const SpreadForce>(axes);
  add_vector_expressions(input, "Force", false, load);
  return load;
}

} // namespace

LoadType force_type() {
  return {
      "force",
      "total force of fixed direction, on a point, on nodes, or spread evenly over the undeformed faces",
      with_axes(
          {loaded_faces(),
           {"Force", "0 ; 0 ; 0", TypeParameter::Kind::text,
            "Three muParser expressions of the time t and the names of amplitudes. [force]"},
           {"Point", "", TypeParameter::Kind::text,
            "Point 'x, y, z' of the undeformed body on which the force acts. Empty: the faces of 'Boundary "
            "ids'. [length]"},
           loaded_nodes(),
           {"Place", "material point", TypeParameter::Kind::choice,
            "material point|nearest node: Nodes on which the force acts. material point: those around the "
            "point, by their shape functions. nearest node: the one nearest to it."}}),
      make_force};
}

} // namespace billet
