// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_LOAD_H
#define BILLET_CONTACT_CONTACT_LOAD_H

#include "billet/contact/traction.h"
#include "billet/discretization/discretization.h"

#include <algorithm>
#include <array>
#include <vector>

namespace billet {

/// What a contact pair does to the scene.
struct ContactLoad {
  dealii::Tensor<1, 3> force; ///< on the body, by the tool or the second body [force]
  dealii::Tensor<1, 3>
      moment;       ///< about the tool's moved centre; of two bodies, about the origin [force length]
  double area = 0.; ///< current area in contact [length²]
  double stored_energy = 0.; ///< in the penalty springs [energy]
  double dissipation = 0.;   ///< by friction in this step [energy]
  double damping = 0.;       ///< of its springs in this step, by FrictionAccount [energy]
  double deepest = 0.;       ///< largest penetration [length]

  ContactLoad &operator+=(const ContactLoad &other);
};

/// Sums, and for the penetration the maximum, over all ranks.
ContactLoad sum_over_ranks(const ContactLoad &local, MPI_Comm communicator);

/// How deep the deepest of some nodes that press is.
struct Penetration {
  double of_facet = 0.; ///< in sizes of the facets around the deepest by that measure
  double length = 0.;   ///< of the deepest by this one [length]

  void add(const double depth, const double facet_size) {
    of_facet = std::max(of_facet, depth / facet_size);
    length = std::max(length, depth);
  }
};

/// What the springs of contact take of the work that is done on bodies [energy].
struct SpringWork {
  double normal = 0.;     ///< by penetrations so far, ½ Σ p g A
  double tangential = 0.; ///< by the elastic slip of nodes that stick, in this step, Σ |t| s A
};

/// Of nodes that come through a surface, into contact or out of it, in the step that has been or in the next
/// two: with d_i the way along the normal in a step, the energy in such a step is off by up to ⅛ Σ k A d_i².
struct Crossings {
  double springs = 0.; ///< Σ k A d_i² [energy]
  double way = 0.;     ///< largest d_i [length]

  /// Adds a node if it does; what it adds to the springs and how far it has moved out of the surface.
  void add(const double spring, const double gap, const double moved) {
    const double ahead = 2. * std::abs(moved);
    if (gap >= ahead || -gap >= ahead || (gap >= 0. && moved >= 0.))
      return;
    springs += spring * moved * moved;
    way = std::max(way, std::abs(moved));
  }
};

/// State of a slave node, for output.
struct ContactNodeReport {
  std::array<DofIndex, 3> dofs;
  ContactStatus status;
  double pressure, gap, slip;
  double area; ///< this rank's share
  dealii::Tensor<1, 3> traction;
  double penetration = 0.; ///< where it presses: into the surface itself, whatever augmentation has done
  double facet_size = 0.;  ///< of the facets around it
  double curvature = 0.;   ///< turn of the tool along a facet there, over that size [1/length]
};

} // namespace billet

#endif
