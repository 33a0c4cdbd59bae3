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

/// Rigid-body modes of all bodies and driven tools together that neither supports nor contact
/// resist, (Q2).
///
/// The unknowns are z = (v_1, ω_1 L_1, ..., s_1, ...). They are velocity v and spin ω of each body
/// about its centre c, and the rate s of each driven tool. L is the size of the body. A row r z is
/// the relative velocity of two points along a direction d. A body contributes d·v +
/// ((x − c) × d)·ω, a tool −d·v_s s.
///
/// A support, the normal of a point in contact and the surface of a sticking point resist r z of
/// either sign. Their springs are in the tangent, and an unloaded point that opens is no longer in
/// contact. A slipping point resists motion across its slip direction, and along it only backwards,
/// r z < 0. Forward, friction stays at its limit and has no stiffness.
class RigidBodySupport {
public:
  /// Object that a point moves with: a body, or a driven tool with the velocity that a unit rate
  /// gives to the point. Neither is set if the point is fixed or has a prescribed motion.
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
  /// Adds a point whose friction is at its limit and resists no further motion: it shows where its
  /// body would slide.
  void add_spent_contact(const SupportingPoint &point, const Side &of, const Side &on);
  /// Adds a point without contact force: it resists a motion into the surface only, and has no
  /// friction.
  void add_unloaded_contact(const SupportingPoint &point, const Side &of, const Side &on);
  /// Requests Result::is_free. On all ranks.
  void weigh_pushes() { pushes_ = true; }
  /// Requests Result::unresisted for these sets of translations of all bodies; with weigh_pushes().
  /// On all ranks.
  void weigh_translations(std::vector<std::vector<dealii::Tensor<1, 3>>> sets) { sets_ = std::move(sets); }
  /// Adds a point whose normal resists a motion into the surface only, with friction as in
  /// add_contact(). Such points support a body only from both sides: a tool that pushes a loose
  /// body does not.
  void add_pushing_contact(const SupportingPoint &point, const Side &of, const Side &on);
  /// Adds the load of a driven tool, which resists a motion of the tool against it.
  void add_load(std::size_t tool, double load);
  /// Adds constraints on all rigid-body modes of a body.
  void hold(std::size_t body);

  /// Rigid-body mode of one body.
  struct Mode {
    std::size_t body;
    RigidMotion motion;
  };
  struct Result {
    std::size_t n_free = 0;   ///< modes of the bodies that nothing resists
    std::optional<Mode> free; ///< one of them, for the body that moves most in it
    /// Mode that only slipping points resist; if friction is at its limit, along the slip
    /// direction.
    std::optional<Mode> sliding;
    /// Whether each body takes part in a mode that nothing resists, if weigh_pushes(). `free` is
    /// one of these modes then.
    std::vector<bool> is_free;
    /// Parts of each set of weigh_translations() that nothing resists.
    std::vector<std::vector<dealii::Tensor<1, 3>>> unresisted;
  };
  /// Finds the modes from the sums over all ranks; the result is the same on each. Collective.
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
  /// Orthonormal motions without resistance in either direction.
  struct Unresisted {
    /// All rows, including those of tools alone: a body may follow a tool.
    std::vector<Row> all;
    std::vector<Row> of_bodies; ///< one of each set that differs in the motion of tools only
  };
  /// Finds these motions. Collective, like the next two.
  Unresisted find_unresisted_both_ways() const;
  /// Returns the rows of all ranks that resist in one direction only.
  std::vector<Row> gather_one_way() const;
  /// Returns the combination of these motions along which points slip.
  Mode find_sliding(const std::vector<Row> &motions) const;
  /// Finds the bodies that take part in a combination of these motions which `one_way` does not
  /// resist.
  void find_pushed(const std::vector<Row> &motions, const std::vector<Row> &one_way, Result &result) const;
  /// Returns the part of a set of translations that is a combination of these motions and that
  /// `one_way` does not resist.
  std::vector<dealii::Tensor<1, 3>> find_unresisted_part(const std::vector<dealii::Tensor<1, 3>> &set,
                                                         const std::vector<Row> &motions,
                                                         const std::vector<Row> &one_way) const;

  MPI_Comm communicator_;
  std::vector<Body> bodies_;
  std::size_t n_tools_;
  std::vector<double> gram_; ///< Σ r rᵀ of rows that resist both ways, n × n
  bool pushes_ = false;
  std::vector<std::vector<dealii::Tensor<1, 3>>> sets_; ///< of translations of all bodies
  std::vector<double> one_way_; ///< rows that resist r z < 0 only, one after the other
  Row slide_;                   ///< Σ r of spent points, along their slip
};

} // namespace billet

#endif
