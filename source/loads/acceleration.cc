// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/loads/load.h"

namespace billet {

LoadType acceleration_type();

namespace {

/// F_a = m_a a.
class Acceleration final : public BodyLoad {
public:
  dealii::Tensor<1, 3> acceleration(const double *values) const override {
    return dealii::Tensor<1, 3>({values[0], values[1], values[2]});
  }
};

} // namespace

LoadType acceleration_type() {
  return {"acceleration",
          "acceleration of the whole body, such as gravity",
          {{"Acceleration", "0 ; 0 ; 0", TypeParameter::Kind::text,
            "Three muParser expressions of the time t and the names of amplitudes. [length/time^2]"}},
          [](const TypeInput &input) {
            Load load{{}, std::make_shared<const Acceleration>()};
            add_vector_expressions(input, "Acceleration", false, load);
            return load;
          }};
}

} // namespace billet
