// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_CONTACT_REVIEW_H
#define BILLET_SOLVE_CONTACT_REVIEW_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"
#include "billet/solve/load_paths.h"
#include "billet/solve/path_softness.h"
#include "billet/solve/solution.h"
#include "billet/solve/stick_softness.h"
#include "billet/state.h"

#include <map>
#include <string>
#include <vector>

namespace billet {

/// Distribution of a pair's force over nodes, each counted with its mirror images.
struct ForceSpread {
  double force = 0., squares = 0.; ///< Σ m F, Σ m F²
  /// Σ 1, Σ p, Σ p² of the nodes themselves.
  double nodes = 0., pressures = 0., pressure_squares = 0.;
  double on_coarse_curves = 0.; ///< force of nodes with fewer than five facets on a quarter turn
  /// Energy Σ F²/(2 E h) of the indentation by single nodes, and the energy of all deformation and
  /// contact at that time [energy].
  double indentation = 0., deformation = 0.;

  /// Returns the number of equal forces with the same spread: (Σ m F)²/Σ m F².
  double effective_nodes() const { return squares > 0. ? force * force / squares : 0.; }
  /// Whether pressures are uniform, as between flat faces, which need no more nodes.
  bool is_uniform() const;
  /// Whether the nodes are too few to resolve the indentation, if its energy is a relevant part of
  /// the deformation. For a strip that bends over a roll one row of nodes is enough.
  bool has_few_nodes() const;
  /// Returns the part of the force on coarse curves.
  double part_on_coarse() const { return force > 0. ? on_coarse_curves / force : 0.; }
};

/// Reviews contact over a whole run. It checks the part of penetration in each load path's
/// deformation, pairs with few contact nodes, and facets that are coarse for the tool's radius. It
/// also checks for tangential penalties that are too low, pairs and tools without contact, and
/// implausible forces.
class ContactReview {
public:
  ContactReview(const Scene &scene, const Discretization &discretization);

  /// Adds an accepted step; in explicit scenes a step now and then. Returns what it shows of forces
  /// that are past their maximum. Collective.
  DiagnosticList add(const Solution &solution);
  /// Returns the diagnostics at the end of the run.
  DiagnosticList finish() const;

  /// Returns the part by which penetration makes forces too small, along the softest load path,
  /// (L6). Returns 0 if it is below the limit of the warning.
  double penalty_error() const;

  /// Returns why the mesh does not resolve the contact; empty if it does. Too few nodes bear force,
  /// or facets are too coarse for the curves of a tool. A tenth of the force there suffices, though
  /// it makes no warning.
  std::string describe_unresolved() const;

  /// Whether any surface has touched itself.
  bool self_contact_touches() const;

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  struct Pair {
    std::string name;
    std::vector<std::size_t> bodies;
    std::size_t tool = none;    ///< or none
    bool may_stay_open = false; ///< self-contact, or a pair of 'Contact = all'
    bool is_augmented = false;
    bool is_softer_tangentially = false; ///< than in the normal direction
    bool has_touched = false;
    double max_force = 0., time = 0.; ///< of the largest force
    ForceSpread spread;               ///< at the largest force
    /// ∫F dt over the run, and its part on coarse curves as in ForceSpread.
    double impulse = 0., impulse_on_coarse = 0.;
    double coarsest = 0.; ///< facet size / radius of the tool under a force, largest of the run

    /// Returns the part of the force on coarse curves, at its maximum or over the run.
    double part_on_coarse() const;
    bool is_coarse_on_curves() const;
    /// Largest friction and largest lost friction, each over the run.
    StickSoftness max_friction;
    double max_of_edges = 0.; ///< lower bound of the force on crossing edges [force]
    /// Whether few nodes at the largest force so far were reported.
    bool is_spread_reported = false;
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  ForceSpread spread_of(const Pair &pair, const std::vector<ContactNodeReport> &reports) const;
  /// Adds the forces of a step that ends at this time to those on curves. Collective.
  void add_on_curves(const std::vector<std::vector<ContactNodeReport>> &reports, double time);
  /// Returns the message if few nodes bear the largest force of a pair and none was reported.
  static DiagnosticList judge_spread(const Pair &pair);
  void judge_pairs(DiagnosticList &diagnostics) const;
  void judge_paths(DiagnosticList &diagnostics) const;
  void judge_forces(DiagnosticList &diagnostics) const;

  const Scene &scene_;
  const Discretization &discretization_;
  /// Numbers of mirror images of a node by symmetry planes.
  struct Images {
    /// Images by planes away from it, itself included; images by planes through it.
    double apart = 1., on_it = 1.;
  };
  std::map<DofIndex, Images> images_; ///< by first dof, on this rank
  /// Largest face of the bounding box of each body [length²].
  std::vector<double> sections_;
  std::vector<Pair> pairs_; ///< with tools first
  std::vector<LoadPath> paths_;
  std::vector<PathSoftness> softness_; ///< by path
  std::vector<double> tool_forces_;    ///< largest, by tool
  StickSprings stick_springs_;
  double time_ = 0.; ///< of the last step added; NaN: unknown
};

} // namespace billet

#endif
