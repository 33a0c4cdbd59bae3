// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FRICTION_USE_H
#define BILLET_CONTACT_FRICTION_USE_H

#include "billet/contact/traction.h"
#include "billet/friction/friction_law.h"

#include <deal.II/base/tensor.h>

#include <algorithm>

namespace billet {

/// Use that a contact pair makes of friction: sums over the nodes that press [force].
struct FrictionUse {
  double tangential = 0.; ///< of the tangential forces
  double limit = 0.;      ///< of their limits
  double slipping = 0.;   ///< of the limits at nodes that slip

  /// Adds a node with this area and traction.
  void add(const FrictionLaw &law, const ContactStatus status, const dealii::Tensor<1, 3> &normal,
           const double area, const dealii::Tensor<1, 3> &traction) {
    const double pressure = traction * normal;
    const double of_node = area * law.limit(std::max(0., pressure), 0.).value;
    tangential += area * (traction - pressure * normal).norm();
    limit += of_node;
    slipping += status == ContactStatus::slip ? of_node : 0.;
  }
  FrictionUse &operator+=(const FrictionUse &other) {
    tangential += other.tangential;
    limit += other.limit;
    slipping += other.slipping;
    return *this;
  }
};

} // namespace billet

#endif
