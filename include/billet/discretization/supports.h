// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_SUPPORTS_H
#define BILLET_DISCRETIZATION_SUPPORTS_H

#include "billet/algebra/matrix.h"
#include "billet/discretization/constraint_lines.h"
#include "billet/usage.h"

#include <deal.II/lac/full_matrix.h>

#include <map>
#include <set>

namespace billet {

/// Where a tangent is assembled to. If `lift` is given, the constraints' values are put to the right-hand
/// side of the linear system.
struct TangentSystem {
  const Constraints &constraints;
  Matrix &matrix;
  Vector *lift = nullptr; ///< additive
  double weight = 1.;     ///< of all that is added

  void add(const dealii::FullMatrix<double> &local, const std::vector<DofIndex> &dofs) const;
};

/// A node that is held by planes n · u = value.
struct HeldNode {
  std::vector<const Hold *> holds; ///< in the order of the scene
  std::array<DofIndex, 3> dofs;
  dealii::Point<3> position; ///< undeformed
};

/// All held nodes of the cells that this rank owns, and of their ghosts, by their first dof.
std::map<DofIndex, HeldNode> collect_held_nodes(const Scene &scene, const Discretization &discretization);

/// First dofs of those of them that are held in all directions.
std::set<DofIndex> collect_fixed_nodes(const Scene &scene, const Discretization &discretization);

/// The prescribed displacements of a held node, as far as they change with time.
class SupportTrack {
public:
  std::array<double, 3> at(double t) const;

private:
  friend class Supports;
  struct Part {
    const Hold *hold;
    double weight;
    unsigned int line; ///< of at most three
  };
  std::vector<Part> parts_;
  dealii::Point<3> position_;
};

/// Supports, prescribed displacements and symmetry planes as linear constraints on nodal displacements,
/// behind those of hanging nodes. The planes n · u = value that meet at a node may have any normals; at most
/// three of them are independent.
class Supports {
public:
  Supports(const Scene &scene, const Discretization &discretization);

  /// Constraints with right-hand sides 0: for assembly and for Newton's corrections. Their pattern never
  /// changes.
  const Constraints &homogeneous() const { return homogeneous_; }

  /// The same with the values at time t. Throws InputError where planes at one node contradict each other.
  Constraints at_time(double t) const;

  /// The same with the change of the values from t_n to t, for linear steps. `moves`, alike on all ranks,
  /// tells whether any of them changes.
  Constraints change(double t_n, double t, bool &moves) const;

  /// Folds forces on constrained dofs into those that they depend on, and empties them. Collective.
  void condense(Vector &forces) const;

  /// Of some of this rank's nodes, spread evenly; supports that rest have none.
  std::vector<SupportTrack> moving_nodes() const;

private:
  struct Term {
    const Hold *hold;
    double weight;
  };
  /// What a line prescribes: Σ weight value(t).
  struct Prescription {
    std::vector<Term> terms;
    dealii::Point<3> position;
    double value(double t) const;
  };
  /// Σ weight value(t) must vanish.
  struct Redundancy {
    std::vector<Term> terms;
    std::string holds; ///< their names, for messages
    dealii::Point<3> position;
  };
  void eliminate(const std::vector<const Hold *> &holds, const std::array<DofIndex, 3> &dofs,
                 const dealii::Point<3> &position);
  /// `values` of lines_; none: all are 0.
  Constraints build(std::vector<double> values) const;

  const Discretization &discretization_;
  std::vector<ConstraintLine> hanging_nodes_, lines_;
  std::vector<Prescription> prescriptions_; ///< of lines_
  std::vector<Redundancy> redundancies_;
  Constraints homogeneous_;
  bool couples_ranks_ = false; ///< some rank's constraints name dofs that another rank owns
  HeldMemory moving_memory_{Capability::moving_supports};
};

} // namespace billet

#endif
