// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_LOAD_H
#define BILLET_CONTACT_CONTACT_LOAD_H

#include "billet/contact/traction.h"
#include "billet/discretization/discretization.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace billet {

/// Load, energies and area of a contact pair.
struct ContactLoad {
  dealii::Tensor<1, 3> force; ///< on the body, by the tool or the second body [force]
  /// Moment about the tool's moved centre; for two bodies, about the origin [force length].
  dealii::Tensor<1, 3> moment;
  double area = 0.;          ///< current area in contact [length²]
  double stored_energy = 0.; ///< in the penalty springs [energy]
  double dissipation = 0.;   ///< by friction in this step [energy]
  /// Work of the tangential springs in this step, see FrictionAccount [energy].
  double damping = 0.;
  /// Work on the springs by gap offsets that fade in this explicit step [energy].
  double ramp_work = 0.;
  double deepest = 0.; ///< maximum penetration [length]

  ContactLoad &operator+=(const ContactLoad &other);
};

/// Returns the sum over all ranks, and the maximum penetration.
ContactLoad sum_over_ranks(const ContactLoad &local, MPI_Comm communicator);

/// Maximum penetration of nodes that press.
struct Penetration {
  double of_facet = 0.; ///< relative to the size of the facets around the node
  double length = 0.;   ///< absolute [length]

  void add(const double penetration, const double facet_size) {
    of_facet = std::max(of_facet, penetration / facet_size);
    length = std::max(length, penetration);
  }
};

/// Magnitudes of the nodal forces of a contact, summed, and the part that its springs carry: the
/// part that augmentation has not transferred to multipliers.
struct ContactSprings {
  struct Direction {
    double force = 0., held = 0.;               ///< [force]
    std::vector<dealii::Tensor<1, 3>> of_nodes; ///< their forces [force]

    void add(const std::size_t node, const dealii::Tensor<1, 3> &of_node, const double held_by_node) {
      force += of_node.norm();
      held += held_by_node;
      of_nodes[node] += of_node;
    }
  };
  Direction normal;     ///< Σ p A, Σ k_n |g| A
  Direction tangential; ///< Σ |t| A, Σ k_t s A, s the elastic slip in this step

  void add(const std::size_t node, const dealii::Tensor<1, 3> &force, const dealii::Tensor<1, 3> &along,
           const double held, const double held_tangentially) {
    const dealii::Tensor<1, 3> of_pressure = (force * along) * along;
    normal.add(node, of_pressure, held);
    tangential.add(node, force - of_pressure, held_tangentially);
  }
};

/// Nodes that cross a surface, into contact or out of it, in the last step or in the next two. With
/// d_i the displacement along the normal in a step, the energy error in such a step is at most ⅛ Σ
/// k A d_i².
struct Crossings {
  double springs = 0.; ///< Σ k A d_i² [energy]
  double way = 0.;     ///< maximum d_i [length]

  /// Adds a node if it crosses: `spring` is its k A, `moved` its displacement out of the surface.
  void add(const double spring, const double gap, const double moved) {
    const double ahead = 2. * std::abs(moved);
    if (gap >= ahead || -gap >= ahead || (gap >= 0. && moved >= 0.))
      return;
    springs += spring * moved * moved;
    way = std::max(way, std::abs(moved));
  }
};

/// All forces on a node of a contact surface (C13): its own, and the reactions to other nodes that
/// touch its facets. With two passes, pressure and traction of a slave are only its own part.
struct SurfaceForce {
  dealii::Tensor<1, 3> force; ///< on the body [force]
  double of_pressures = 0.;   ///< sum of the forces along their normals, > 0 in compression [force]
  double area = 0.;           ///< of the facets around it [length²]

  double pressure() const { return area > 0. ? of_pressures / area : 0.; }
  dealii::Tensor<1, 3> traction() const { return area > 0. ? force / area : dealii::Tensor<1, 3>(); }
};

/// State of a slave node, for output.
struct ContactNodeReport {
  std::array<DofIndex, 3> dofs;
  ContactStatus status;
  double pressure, gap, slip;
  double area; ///< this rank's share
  dealii::Tensor<1, 3> traction;
  /// Penetration where it presses: into the surface itself, regardless of augmentation.
  double penetration = 0.;
  double facet_size = 0.; ///< of the facets around it
  /// Stiffness of the spring that it sticks to; 0 without friction [force/length³].
  double tangential_stiffness = 0.;
  /// Change of the tool's normal along a facet there, over its size [1/length].
  double curvature = 0.;
  /// This rank's parts of all forces, of surfaces whose nodes are slaves and whose facets are
  /// touched, too.
  std::optional<SurfaceForce> total = {};
};

} // namespace billet

#endif
