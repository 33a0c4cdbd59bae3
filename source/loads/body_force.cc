// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/load.h"

namespace billet {

LoadType body_force_type();

namespace {

/// F_a = V_a b, with the undeformed volume of the node.
class BodyForce final : public BodyLoad {
public:
  dealii::Tensor<1, 3> acceleration(const double *values) const override {
    return dealii::Tensor<1, 3>({values[0], values[1], values[2]});
  }
  bool is_per_volume() const override { return true; }
};

} // namespace

LoadType body_force_type() {
  return {"body force",
          "force per undeformed volume of the whole body",
          {{"Body force", "0 ; 0 ; 0", TypeParameter::Kind::text,
            "Three muParser expressions of the time t and the names of amplitudes. [force/length^3]"}},
          [](const TypeInput &input) {
            Load load{{}, std::make_shared<const BodyForce>()};
            add_vector_expressions(input, "Body force", false, load);
            return load;
          }};
}

} // namespace billet
