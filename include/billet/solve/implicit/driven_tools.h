// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_DRIVEN_TOOLS_H
#define BILLET_SOLVE_IMPLICIT_DRIVEN_TOOLS_H

#include "billet/solve/implicit/contact_set.h"
#include "billet/solve/implicit/scheme.h"

#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Tools that a force or a moment drives: their offsets, beyond the prescribed motion, are unknowns beside
/// the displacements. The tangent is bordered by them,
///   K du + B ds = r_u,   C du + D ds = r_s.
/// The unknown of a tool that turns, and its equation, are scaled by the scene's radius to a length and a
/// force. Tools that have reached their stop force stay where they are.
class DrivenTools {
public:
  DrivenTools(const Scene &scene, const Discretization &discretization, const Supports &supports,
              ContactSet &contacts, const ImplicitScheme &scheme);

  /// Offsets of all tools, of the trial state and at the start of the step [length or angle].
  const std::vector<double> &offsets() const { return offsets_; }
  void set_offsets(const std::vector<double> &offsets) { offsets_ = offsets; }
  const std::vector<double> &start_offsets() const { return offsets_n_; }
  const std::vector<double> &last_increments() const { return last_increments_; }
  /// Sets the trial state to the start of the step.
  void restart() { offsets_ = offsets_n_; }
  /// The trial state becomes the start of the next step.
  void commit();

  /// Tools whose offsets are unknown in this step.
  const std::vector<std::size_t> &unknown() const { return unknown_; }
  void choose_unknown(const std::vector<std::size_t> &tools);
  /// Leaves the tools where they are while a residual of displacements alone is computed; ...
  void leave_in_place() { unknown_.clear(); }
  /// ... then those of the last choose_unknown() are unknown again.
  void free_again(const std::vector<std::size_t> &tools) { unknown_ = tools; }
  /// Vector of displacements and unknown offsets.
  Vector pack(const Vector &displacements, const std::vector<double> &offsets) const;
  /// Takes displacements and unknown offsets from such a vector. Collective.
  void unpack(const Vector &x, Vector &displacements);
  /// Adds the residuals of the unknown tools at time t.
  void add_residual(double t, std::size_t n_displacements, Vector &residual) const;

  Placement place(std::size_t tool, double t, double offset) const;
  /// Of all tools with the trial offsets.
  std::vector<Placement> placements(double t) const;
  /// Moves the tools of contacts there.
  void place_contacts(double t);
  bool is_stopped(const std::size_t tool) const { return stopped_[tool] != nullptr; }
  void stop(const std::size_t tool, const Placement &at) { stopped_[tool] = std::make_unique<Placement>(at); }
  /// Tools of these that press with their stop force at time t. Collective.
  std::vector<std::size_t> find_stopping(double t, const std::function<bool(std::size_t)> &is_removed) const;

  /// Factor from the offset to the unknown.
  double unit_of(std::size_t tool) const;
  RigidContact::ToolRate rate_of(std::size_t tool) const;
  /// Load that the tool exerts along its direction, or about its axis. Collective.
  double exerted_load(std::size_t tool) const;
  /// Residual of a tool, with its inertia if it has a mass. Collective.
  double imbalance(std::size_t tool, double t) const;
  /// Distance by which the tool misses the bodies; infinite if it cannot touch. Collective.
  double distance_to_touch(std::size_t tool) const;

  /// Assembles B, C and D, after the contacts' update(). Collective.
  void assemble_tangent();
  /// Solves K x = b. False if that fails.
  using Solve = std::function<bool(const Vector &b, double relative_tolerance, Vector &x)>;
  /// Solves the bordered system by elimination of du. A tool that touches nothing moves on until it does.
  /// `sense` is 1 where the solution is what is added to the unknowns, −1 where it is what is subtracted.
  bool solve(const Solve &solve, const Vector &r_u, const std::vector<double> &r_s, double sense,
             double relative_tolerance, Vector &du, std::vector<double> &ds);
  /// Reason of the last failure of solve(); empty if it was not a tool.
  const std::string &failure() const { return failure_; }
  void clear_failure() { failure_.clear(); }

  // Into and from the group of a tool:
  void save(std::size_t tool, const Placement &at, StateWriter &writer) const;
  void load(std::size_t tool, StateReader &reader, const Placement &at);
  /// Before load().
  void begin() { last_increments_.assign(offsets_.size(), 0.); }

private:
  /// Blocks that border K.
  struct Border {
    std::vector<Vector> columns, rows; ///< B, condensed; C
    dealii::FullMatrix<double> block;  ///< D
    HeldMemory memory{Capability::driven_tools};
  };
  double excess_load(std::size_t tool, double t) const;

  const Scene &scene_;
  const Discretization &discretization_;
  const Supports &supports_;
  ContactSet &contacts_;
  const ImplicitScheme &scheme_;
  std::vector<double> offsets_, offsets_n_, last_increments_;
  std::vector<std::size_t> unknown_;
  Vector layout_;                                   ///< zeros: displacements and unknown offsets
  std::vector<std::unique_ptr<Placement>> stopped_; ///< where tools have stopped for good
  Border border_;
  std::string failure_;
};

} // namespace billet

#endif
