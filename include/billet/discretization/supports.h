// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_SUPPORTS_H
#define BILLET_DISCRETIZATION_SUPPORTS_H

#include "billet/algebra/matrix.h"
#include "billet/discretization/acting_constraints.h"
#include "billet/discretization/constraint_lines.h"
#include "billet/usage.h"

#include <deal.II/lac/full_matrix.h>

#include <map>
#include <set>

namespace billet {

/// Target of the assembly of a tangent. If `lift` is given, the constraints' values enter the
/// right-hand side of the linear system.
struct TangentSystem {
  const Constraints &constraints;
  Matrix &matrix;
  Vector *lift = nullptr; ///< additive
  double weight = 1.;     ///< factor on everything that is added

  void add(const dealii::FullMatrix<double> &local, const std::vector<DofIndex> &dofs) const;
};

/// Node with constraints n · u = value.
struct ConstrainedNode {
  std::vector<const Constraint *> constraints; ///< in the order of the scene
  std::array<DofIndex, 3> dofs;
  dealii::Point<3> position; ///< undeformed
};

/// Returns all nodes of owned cells and their ghosts that these constraints hold, by their first
/// dof.
std::map<DofIndex, ConstrainedNode> collect_constrained_nodes(const Scene &scene,
                                                              const Discretization &discretization,
                                                              const ConstraintFilter &acts);

/// Returns the first dofs of nodes that are constrained in all directions during the whole run.
std::set<DofIndex> collect_fixed_nodes(const Scene &scene, const Discretization &discretization);

/// Combination of the constraints of a node.
struct ConstraintRow {
  dealii::Tensor<1, 3> n;      ///< sum of the weights times the normals; 0 without a pivot
  std::vector<double> weights; ///< of the constraints
  /// Component of n that is 1; -1 if the constraint depends on those before it.
  int pivot = -1;
};
/// Returns a row for each constraint of a node, solved for their pivots (Gauss-Jordan).
std::vector<ConstraintRow> solve_for_pivots(const ConstrainedNode &node);
/// Returns the names of the constraints in a row: "'symmetry plane x = 0' and 'support top'".
std::string names_in(const ConstraintRow &row, const ConstrainedNode &node);

/// Refuses supports that act at the same time and prescribe displacements that contradict each
/// other, or are not finite. It looks at 17 times between any two at which supports begin or end.
/// Throws InputError. Collective.
void check_agreement(const Scene &scene, const Discretization &discretization);

/// Prescribed displacements of a constrained node, as far as they change with time.
class SupportTrack {
public:
  std::array<double, 3> at(double t) const;

private:
  friend class Supports;
  struct Part {
    const Constraint *constraint;
    double weight;
    unsigned int line; ///< index, 0 to 2
  };
  std::vector<Part> parts_;
  dealii::Point<3> position_;
};

/// Supports, prescribed displacements and symmetry planes as linear constraints on nodal
/// displacements, after those of hanging nodes. The normals of the planes n · u = value that meet
/// at a node are arbitrary; at most three of them are independent.
class Supports {
public:
  Supports(const Scene &scene, const Discretization &discretization);

  /// Returns the constraints with right-hand sides 0, for assembly and Newton's corrections. Their
  /// pattern changes when supports begin or end, and at no other time.
  const Constraints &homogeneous() const { return homogeneous_; }

  /// Returns the constraints with the values at time t. Throws SolutionFailure if constraints at a
  /// node contradict each other.
  Constraints at_time(double t) const;

  /// Returns the constraints with the change of the values from t_n to t, for linear steps. Sets
  /// `moves`, on all ranks alike, to whether any value changes.
  Constraints change(double t_n, double t, bool &moves) const;

  /// Transfers forces on constrained dofs to the dofs on which these depend, and sets them to 0.
  /// Collective.
  void condense(Vector &forces) const;

  /// Returns the constraints that act.
  const ActingConstraints &acting() const { return acting_; }
  /// Lets those supports go that no step after t knows, and whose forces fade over this time.
  /// Collective.
  void release(double t, double fade_time);
  /// Takes the supports that act after t. Those that begin hold the nodes where these
  /// `displacements` (relevant dofs) put them. Collective.
  void take(double t, const Vector &displacements);

  /// Returns the displacements of relevant dofs at the times at which supports that act began, if
  /// later than 0.
  const std::map<double, Vector> &starts() const { return starts_; }
  /// Takes the supports that act after t, with their starts(). Collective.
  void resume(double t, std::map<double, Vector> starts);

  /// Returns the tracks of some of this rank's nodes with moving supports, evenly sampled. It knows
  /// those that begin later, too.
  std::vector<SupportTrack> moving_nodes() const;

private:
  struct Term {
    const Constraint *constraint;
    double weight;
  };
  /// Value that a line prescribes: Σ weight value(t).
  struct Prescription {
    std::vector<Term> terms;
    dealii::Point<3> position;
    /// Part that does not depend on time, of supports that began within the run.
    double start;
    double value(double t) const;
  };
  /// Redundant constraint: Σ weight value(t) must vanish.
  struct Redundancy {
    std::vector<Term> terms;
    std::string constraints; ///< names of its constraints, for messages
    dealii::Point<3> position;
    double start; ///< as of Prescription
  };
  /// Makes the lines of the supports that act. Collective.
  void rebuild();
  /// Returns the position n · u less the value at the time when a late support began.
  double start_of(const Constraint &constraint, const ConstrainedNode &node) const;
  void eliminate(const ConstrainedNode &node);
  /// Builds the constraints with these `values` of lines_; if empty, all are 0.
  Constraints build(std::vector<double> values) const;

  const Scene &scene_;
  const Discretization &discretization_;
  ActingConstraints acting_;
  /// Displacements of relevant dofs at the times when supports began.
  std::map<double, Vector> starts_;
  std::vector<ConstraintLine> links_, lines_;
  std::vector<Prescription> prescriptions_; ///< of lines_
  std::vector<Redundancy> redundancies_;
  Constraints homogeneous_;
  bool couples_ranks_ = false; ///< constraints of some rank name dofs that another rank owns
  HeldMemory moving_memory_{Capability::moving_supports};
};

} // namespace billet

#endif
