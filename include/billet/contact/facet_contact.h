// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CONTACT_H
#define BILLET_CONTACT_FACET_CONTACT_H

#include "billet/contact/facet_bounds.h"
#include "billet/contact/facet_contact_parts.h"
#include "billet/contact/facet_couplings.h"
#include "billet/contact/facet_measures.h"
#include "billet/contact/facet_penalties.h"
#include "billet/contact/facet_works.h"
#include "billet/contact/slave_evaluation.h"
#include "billet/contact/slave_tangents.h"
#include "billet/state.h"

#include <memory>
#include <optional>
#include <vector>

namespace billet {

/// Node-to-facet contact between the surfaces of deformable bodies, or of one with itself. A
/// penalty keeps slave nodes out of facets, with friction in a frame that each node carries along.
/// The force on a node is its traction times its share of its own facets' area. The facet's corners
/// take the reaction, which balances force and moment.
///
/// With overlaps, contact is facet-to-facet. The gap of a slave node a is the mean over all
/// polygons of its facets, weighted by its function, g_a = Σ ∫ φ_a g dA/A_a with A_a = Σ ∫ φ_a dA.
/// Its traction t_a acts by the same functions, F_b = Σ_a t_a ∫ φ_a φ_b dA on the slave's nodes and
/// −Σ_a t_a ∫ φ_a ψ_I dA on the target's.
///
/// Input and output are plain arrays: nodes and facets are those of this rank; SurfaceExchange
/// brings facets of other ranks. A node that several ranks have is a slave on each, with the area
/// of that rank's facets. Its state is the same on all of them. The caller sums its forces over
/// these ranks, as it does with forces of elements.
///
/// This class advances the state, which FacetContactParts contain. Its measures(), works(),
/// bounds(), tangents() and couplings() evaluate the state of the last add_forces(); penalties()
/// augments and scales.
class FacetContact {
public:
  using Positions = FacetSearch::Positions;

  /// `node_keys` and `facets` are as for SurfaceExchange. `stiffness` are the full penalties of
  /// each node as a slave, `sizes` the sizes of the facets around it [length].
  FacetContact(MPI_Comm communicator, const FacetContactSettings &settings,
               std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets,
               const std::vector<ContactStiffness> &stiffness, const std::vector<double> &sizes);

  /// Adds contact forces at `positions` to `forces`; `positions_n` are those of the last commit(),
  /// and `duration` is the time in between. All are of this rank's nodes. Collective.
  void add_forces(const Positions &positions_n, const Positions &positions, double duration,
                  Positions &forces);

  // The last add_forces().

  const SlaveTangents &tangents() const { return *tangents_; }
  FacetCouplings &couplings() { return couplings_; }
  const FacetMeasures &measures() const { return measures_; }
  FacetPenalties &penalties() { return penalties_; }
  const FacetWorks &works() const { return works_; }
  FacetBounds &bounds() { return bounds_; }
  /// Exchange that brings data of own nodes to ghosts, and sums back.
  const SurfaceExchange &exchange() const { return parts_.surfaces.exchange(); }
  const FacetSearch &search() const { return parts_.surfaces.search(); }
  FacetMethod method() const { return parts_.settings.method; }

  /// Sets how works of friction are counted: with ½, and those of a motion, by default.
  void set_friction_account(double start_weight, const FrictionAccounting &accounting);
  /// Returns the number of doubles of history on this rank.
  std::size_t history_size() const;

  /// Makes the state of the last add_forces() the start of the next step.
  void commit();

  /// Closes initial gaps of undeformed surfaces, before any other call. Nodes in front of a facet
  /// of the other surface by at most `within` [length] permanently count as touching it without
  /// pressure. Nodes of overlapping facets do so by their mean gap; allow_initial_penetrations()
  /// then allows larger penetrations. Collective.
  void close_initial_gaps(const Positions &positions, double within);
  /// Allows the penetrations at the last add_forces(), before the first commit(). From then on,
  /// only the excess over the allowed part counts; that part is initially 1. Overlapping facets may
  /// still find a penetration, which another call after another add_forces() allows. Returns the
  /// maximum new penetration on this rank [facet sizes].
  double allow_initial_penetrations();
  /// After these two: carries what they have found to the nodes that had no partner at the start,
  /// (C15). A surface in contact with itself has no such nodes. Collective.
  void carry_initial_gaps(const Positions &positions);
  /// Sets the allowed part at the start and the end of the step.
  void set_allowed_part(const double at_start, const double at_end) {
    parts_.offsets.penetrations.set_allowed_part(at_start, at_end);
  }

  /// Returns to the state of the last commit(), to attempt a step or to repeat it.
  void restart();
  /// Saves the state at the start of the step, by the keys of nodes and facets. The caller saves
  /// the positions at the last commit().
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  void update_surfaces(const Positions &positions_n, const Positions &positions);
  void count_changes();
  void record_start(std::size_t s);
  /// Returns the gaps of all slaves at the start, less `lowered` [length]. Collective.
  std::vector<double> measure_gaps(const Positions &positions, double lowered);
  std::vector<std::uint64_t> slave_keys() const;

  FacetContactParts parts_;
  /// Directions to the partner, of the slaves that start in contact; empty unless initial gaps are
  /// changed.
  std::vector<std::optional<dealii::Tensor<1, 3>>> start_directions_;
  std::unique_ptr<SlaveEvaluation> evaluation_;
  std::unique_ptr<SlaveTangents> tangents_;
  FacetCouplings couplings_;
  FacetMeasures measures_;
  FacetPenalties penalties_;
  FacetWorks works_;
  FacetBounds bounds_;
};

} // namespace billet

#endif
