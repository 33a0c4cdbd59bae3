// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/load.h"

namespace billet {

LoadType dead_traction_type();

namespace {

/// F_a = ∫ N_a t dA, where t is a force per undeformed area, in axes at each point.
class DeadTraction final : public DeadLoad<NodalLoad> {
public:
  explicit DeadTraction(const Axes &axes) : axes_(axes) {}

  void add_forces(const std::vector<LoadedNode> &nodes, const LoadValues &values,
                  const NodalMotion & /*motion*/, double *forces) const override {
    for (std::size_t k = 0; k < nodes.size(); ++k)
      add_vector(forces, nodes[k].node, nodes[k].area * axes_.to_global(values.at(k), nodes[k].centre));
  }

private:
  Axes axes_;
};

} // namespace

LoadType dead_traction_type() {
  return {"dead traction", "force per undeformed area of the faces, of fixed direction",
          with_axes({loaded_faces(),
                     {"Traction", "0 ; 0 ; 0", TypeParameter::Kind::text,
                      "Three expressions of the undeformed position x, y, z, the time t and the names of "
                      "amplitudes. [stress]"}}),
          [](const TypeInput &input) {
            Load load{{}, std::make_shared<const DeadTraction>(Axes(input))};
            add_vector_expressions(input, "Traction", true, load);
            return load;
          }};
}

} // namespace billet
