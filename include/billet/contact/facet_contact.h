// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CONTACT_H
#define BILLET_CONTACT_FACET_CONTACT_H

#include "billet/contact/facet_bounds.h"
#include "billet/contact/facet_contact_parts.h"
#include "billet/contact/facet_couplings.h"
#include "billet/contact/facet_measures.h"
#include "billet/contact/facet_works.h"
#include "billet/contact/slave_evaluation.h"
#include "billet/contact/slave_tangents.h"
#include "billet/state.h"

#include <memory>
#include <vector>

namespace billet {

/// Contact between the surfaces of deformable bodies, or of one with itself, node against facet: slave nodes
/// are held out of facets by a penalty, with friction in a frame that each node carries along. The force on a
/// node is its traction times its share of its own facets' area; the facet's corners take the reaction, which
/// balances force and moment.
///
/// With overlaps, facet against facet: the gap of a slave node a is the mean over all polygons of its facets,
/// weighted by its function, g_a = Σ ∫ φ_a g dA/A_a with A_a = Σ ∫ φ_a dA; its traction t_a acts by the same
/// functions, F_b = Σ_a t_a ∫ φ_a φ_b dA on the slave's nodes and −Σ_a t_a ∫ φ_a ψ_I dA on the target's.
///
/// Plain arrays in and out: nodes and facets are those of this rank, facets of other ranks come by
/// SurfaceExchange. A node that several ranks have is a slave on each, with the area of that rank's facets;
/// its state is the same on all of them. Forces on it are to be summed over these ranks, as forces of
/// elements are.
///
/// This class steps the state, which FacetContactParts are; what it is at the last add_forces() its
/// measures(), works(), bounds(), tangents() and couplings() say.
class FacetContact {
public:
  using Positions = FacetSearch::Positions;

  /// `node_keys` and `facets` as SurfaceExchange wants them; of each node the full penalties as a slave, and
  /// the size of the facets around it.
  FacetContact(MPI_Comm communicator, const FacetContactSettings &settings,
               std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets,
               const std::vector<ContactStiffness> &stiffness, const std::vector<double> &sizes);

  /// Adds contact forces at `positions` to `forces`; `positions_n` are those of the last commit(), and
  /// `duration` is the time in between. All are of this rank's nodes. Collective.
  void add_forces(const Positions &positions_n, const Positions &positions, double duration,
                  Positions &forces);

  // The last add_forces().

  const SlaveTangents &tangents() const { return *tangents_; }
  FacetCouplings &couplings() { return couplings_; }
  const FacetMeasures &measures() const { return measures_; }
  const FacetWorks &works() const { return works_; }
  FacetBounds &bounds() { return bounds_; }
  /// To bring data of own nodes to ghosts, and sums back.
  const SurfaceExchange &exchange() const { return parts_.surfaces.exchange(); }
  const FacetSearch &search() const { return parts_.surfaces.search(); }
  FacetMethod method() const { return parts_.settings.method; }

  /// Of FrictionRule, by which friction is accounted for: ½ and false unless they are set.
  void set_friction_account(double start_weight, bool is_static);
  /// Doubles of history on this rank.
  std::size_t history_size() const;

  /// The state of the last add_forces() becomes the start of the next step.
  void commit();

  /// Of undeformed surfaces, before anything else: nodes that are before a facet of the other one by no more
  /// than `within` count as touching it without pressure, from where they are, for good. Nodes of overlapping
  /// facets by their mean gap; what then is deeper than that, allow_initial_depths() allows. Collective.
  void close_initial_gaps(const Positions &positions, double within);
  /// How deep nodes are in facets at the last add_forces(), before the first commit(), is allowed: only what
  /// is deeper than a part of it counts from then on, at first all of it. What overlapping facets then still
  /// find is allowed by another call after another add_forces(). Returns the deepest that was new on this
  /// rank [facet sizes].
  double allow_initial_depths();
  /// Sets that part at the start and the end of the step.
  void set_allowed_part(const double at_start, const double at_end) {
    parts_.offsets.depths.set_allowed_part(at_start, at_end);
  }

  // The augmented Lagrangian by Uzawa's method, see MultiplierOffsets. In the same way a sticking node's
  // traction becomes what its spring starts from.

  /// Back to what the last commit() left: of a step that is tried, or tried anew.
  void restart();
  /// Takes back the augmentations since the last restart() or commit().
  void take_back_augmentation();
  /// Multiplier offsets and tractions become those of the last add_forces().
  void augment();
  /// Makes all penalties so many times as stiff; what augmentation holds stays. After augment().
  void scale_penalties(double normal, double tangential);
  /// As ContactInterface's.
  void stiffen_under_load(double normal, double tangential);
  /// The factors so far.
  double stiffening() const { return parts_.penalties.stiffening(); }
  double tangential_stiffening() const { return parts_.penalties.tangential_stiffening(); }

  /// The state at the start of the step, by the keys of nodes and facets. The positions at the last commit()
  /// are the caller's.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  void update_surfaces(const Positions &positions_n, const Positions &positions);
  void count_changes();
  std::vector<std::uint64_t> slave_keys() const;

  FacetContactParts parts_;
  std::unique_ptr<SlaveEvaluation> evaluation_;
  std::unique_ptr<SlaveTangents> tangents_;
  FacetCouplings couplings_;
  FacetMeasures measures_;
  FacetWorks works_;
  FacetBounds bounds_;
  Positions nodal_forces_; ///< with ghosts, of one step
};

} // namespace billet

#endif
