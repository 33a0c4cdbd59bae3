// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACING_GAPS_H
#define BILLET_CONTACT_FACING_GAPS_H

#include "billet/scene/scene.h"

#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <limits>
#include <optional>
#include <vector>

namespace billet {

/// Whether initial gaps or penetrations of a pair count as none for good.
inline bool changes_gaps(const InitialOverlap &overlap) {
  return overlap.ramp_time == 0. && (overlap.is_allowed || overlap.closed_gap > 0.);
}

/// Least initial gap of a face that starts in contact, by the direction in which the face looks,
/// (C15) of doc/theory. A partner that slides on meets nodes that had no partner at the start.
/// These nodes count as raised or lowered like the face beside them, as if the partner had been
/// placed in contact.
class FacingGaps {
public:
  /// Gap of a node that no partner is in front of.
  static constexpr double unknown = std::numeric_limits<double>::infinity();

  FacingGaps();
  /// Adds a node that starts in contact. `outward` points to the partner, and has any length > 0;
  /// `gap` < 0 is a penetration [length].
  void add(const dealii::Tensor<1, 3> &outward, double gap);
  /// Combines the nodes of all ranks. Collective.
  void reduce(MPI_Comm communicator);
  /// Returns the least gap of the nodes that look within about 55 degrees of `outward`; nothing
  /// without any.
  std::optional<double> find(const dealii::Tensor<1, 3> &outward) const;
  /// Returns the penetration that counts as none at a node that does not start in contact and has
  /// this gap [length]. It is negative if the gap counts as smaller.
  double carried_penetration(const dealii::Tensor<1, 3> &outward, double gap) const;

private:
  std::vector<double> gaps_; ///< by direction; `unknown` without nodes
};

} // namespace billet

#endif
