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

/// How a pair's force is spread over nodes, each counted with its mirror images.
struct ForceSpread {
  double force = 0., squares = 0.;                          ///< Σ m F, Σ m F²
  double nodes = 0., pressures = 0., pressure_squares = 0.; ///< Σ 1, Σ p, Σ p² of the nodes themselves
  double on_coarse_curves = 0.; ///< force of nodes with fewer than five facets on a quarter turn
  double coarsest = 0.;         ///< facet size / radius of the tool, largest
  /// Of the indentations of single nodes, Σ F²/(2 E h), and all that bodies and contacts have taken by then
  /// [energy].
  double indentation = 0., deformation = 0.;

  /// By how many equal forces: (Σ m F)²/Σ m F².
  double effective_nodes() const { return squares > 0. ? force * force / squares : 0.; }
  /// Whether pressures are alike, as of a flat face on another, which needs no more nodes.
  bool is_uniform() const;
  /// Too few for the indentation, if that is a part of the deformation that counts: a strip that bends over a
  /// roll needs no more than a row of nodes.
  bool has_few_nodes() const;
  bool is_coarse_on_curves() const;
};

/// Judges contact over a whole run: what penetration makes softer along each load path, pairs that few nodes
/// carry, facets that are large beside the tool's radius, tangential springs that are too soft, pairs and
/// tools without contact, forces beyond what bodies bear.
class ContactReview {
public:
  ContactReview(const Scene &scene, const Discretization &discretization);

  /// After an accepted step; of explicit scenes now and then. Collective.
  void add(const Solution &solution);
  /// At the end of the run.
  DiagnosticList finish() const;

  /// By what part forces are too small since penetration takes it, along the softest load path, (L6); 0 where
  /// that is little.
  double penalty_error() const;

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  struct Pair {
    std::string name;
    std::vector<std::size_t> bodies;
    std::size_t tool = none; ///< or none
    bool is_self_contact = false;
    bool is_augmented = false;
    bool is_softer_tangentially = false; ///< than in the normal direction
    bool has_touched = false;
    double largest_force = 0., time = 0.; ///< and when
    ForceSpread spread;                   ///< at the largest force
    StickSoftness largest_friction;       ///< what it has and what it lacks, each over the run
    double largest_of_edges = 0.;         ///< force that edges carry, at least [force]
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  ForceSpread spread_of(const Pair &pair, const std::vector<ContactNodeReport> &reports) const;
  void judge_pairs(DiagnosticList &diagnostics) const;
  void judge_paths(DiagnosticList &diagnostics) const;
  void judge_forces(DiagnosticList &diagnostics) const;

  const Scene &scene_;
  const Discretization &discretization_;
  /// Of a node, with symmetry planes.
  struct Images {
    double apart = 1., on_it = 1.; ///< elsewhere, itself included, and in the same place
  };
  std::map<DofIndex, Images> images_; ///< by first dof, on this rank
  std::vector<double> sections_;      ///< of the bodies: the largest face of the box around [length²]
  std::vector<Pair> pairs_;           ///< with tools first
  std::vector<LoadPath> paths_;
  std::vector<PathSoftness> softness_; ///< by path
  std::vector<double> tool_forces_;    ///< largest, by tool
  StickSprings stick_springs_;
};

} // namespace billet

#endif
