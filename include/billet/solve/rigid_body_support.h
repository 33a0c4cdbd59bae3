// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_RIGID_BODY_SUPPORT_H
#define BILLET_SOLVE_RIGID_BODY_SUPPORT_H

#include "billet/contact/supporting_point.h"
#include "billet/scene/rigid_motions.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/full_matrix.h>

#include <optional>
#include <utility>
#include <vector>

namespace billet {

/// Rigid-body modes of all bodies and driven tools together that neither supports nor contact resist, (Q2).
///
/// The unknowns are z = (v_1, ω_1 L_1, ..., s_1, ...): velocity and spin of each body about its centre c, L
/// its size, and the rate of each tool that a force or moment drives. A row r z is the relative velocity of
/// two points along a direction d: of a body d·v + ((x − c) × d)·ω, of a tool −d·v_s s.
///
/// A support, the normal of a point that touches and the surface of one that sticks resist r z of either
/// sign: their springs are in the tangent, and an unloaded one that opens no longer touches. A point that
/// slips resists a motion across its slip direction; along it only a motion back, r z < 0. Onwards friction
/// keeps its limit and has no stiffness.
class RigidBodySupport {
public:
  /// What moves with a point: a body, a driven tool at the velocity that a unit rate gives to the point, or
  /// neither, if it stands still or moves as prescribed.
  struct Side {
    std::optional<std::size_t> body;
    std::optional<std::size_t> tool;
    dealii::Tensor<1, 3> tool_velocity;
  };
  struct Body {
    dealii::Tensor<1, 3> centre; ///< [length]
    double size;                 ///< > 0 [length]
  };

  RigidBodySupport(MPI_Comm communicator, std::vector<Body> bodies, std::size_t n_tools);

  /// Adds a support of a body at a point.
  void add_support(std::size_t body, const dealii::Tensor<1, 3> &position,
                   const dealii::Tensor<1, 3> &normal);
  /// Adds a point of the body `of` that touches `on`.
  void add_contact(const SupportingPoint &point, const Side &of, const Side &on);
  /// Adds one whose friction is at its limit, and resists nothing more: it says where its body would slide.
  void add_spent_contact(const SupportingPoint &point, const Side &of, const Side &on);
  /// Adds one that no force presses: it resists a motion into the surface only, and has no friction.
  void add_unloaded_contact(const SupportingPoint &point, const Side &of, const Side &on);
  /// Asks for Result::is_free. On all ranks.
  void weigh_pushes() { pushes_ = true; }
  /// Adds one whose normal resists a motion into the surface only, and friction as in add_contact(). Such
  /// points hold a body only from both sides: a tool that pushes a loose body does not.
  void add_pushing_contact(const SupportingPoint &point, const Side &of, const Side &on);
  /// Adds the load of a driven tool, which resists a motion of the tool against it.
  void add_load(std::size_t tool, double load);
  /// Adds a hold of the whole body.
  void hold(std::size_t body);

  /// A mode of one body; its motion is RigidMotion's.
  struct Mode {
    std::size_t body;
    RigidMotion motion;
  };
  struct Result {
    std::size_t n_free = 0;   ///< modes of the bodies that nothing resists
    std::optional<Mode> free; ///< one of them: of the body that moves most in it
    /// One that only points resist that slip; where friction is spent, that along which it was.
    std::optional<Mode> sliding;
    /// Of each body, if weigh_pushes(): whether it takes part in a mode that nothing resists. `free` is one
    /// of these modes then.
    std::vector<bool> is_free;
  };
  /// Sums over all ranks; the result is the same on each. Collective.
  Result find() const;

private:
  using Row = std::vector<double>;
  std::size_t n() const { return 6 * bodies_.size() + n_tools_; }
  void add(const dealii::Tensor<1, 3> &position, const dealii::Tensor<1, 3> &direction, const Side &side,
           double sign, Row &row) const;
  Row row_of(const dealii::Tensor<1, 3> &position, const dealii::Tensor<1, 3> &direction, const Side &of,
             const Side &on) const;
  void add_both_ways(const Row &row);
  void add_one_way(const Row &row) { one_way_.insert(one_way_.end(), row.begin(), row.end()); }
  void add_friction(const SupportingPoint &point, const Side &of, const Side &on);
  Mode mode_of(const Row &motion) const;
  /// Orthonormal motions that nothing resists in both directions.
  struct Unresisted {
    std::vector<Row> all;       ///< tools that move without bodies among them: a body may follow them
    std::vector<Row> of_bodies; ///< of those that differ in the motion of tools only, one
  };
  /// Collective, as the next two.
  Unresisted find_unresisted_both_ways() const;
  /// Returns the rows of all ranks that resist in one direction only.
  std::vector<Row> gather_one_way() const;
  /// Returns the combination of these motions along which points slip.
  Mode find_sliding(const std::vector<Row> &motions) const;
  /// Finds the bodies that take part in a combination of these motions which `one_way` does not resist.
  void find_pushed(const std::vector<Row> &motions, const std::vector<Row> &one_way, Result &result) const;

  MPI_Comm communicator_;
  std::vector<Body> bodies_;
  std::size_t n_tools_;
  std::vector<double> gram_; ///< Σ r rᵀ of rows that resist both ways, n × n
  bool pushes_ = false;
  std::vector<double> one_way_; ///< rows that resist r z < 0 only, one after the other
  Row slide_;                   ///< Σ r of spent points, along their slip
};

} // namespace billet

#endif
