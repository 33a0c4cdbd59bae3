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

/// Tools with a given force or moment: their offsets, beyond the prescribed motion, are unknowns
/// beside the displacements. They border the tangent:
///   K du + B ds = r_u,   C du + D ds = r_s.
/// The unknown of a tool that rotates, and its equation, are scaled by the scene's radius to a
/// length and a force. Tools that have reached their stop force stay in place.
class DrivenTools {
public:
  DrivenTools(const Scene &scene, const Discretization &discretization, const Supports &supports,
              ContactSet &contacts, const ImplicitScheme &scheme);

  /// Returns the offsets of all tools, in the trial state and at the start of the step [length or
  /// angle].
  const std::vector<double> &offsets() const { return offsets_; }
  void set_offsets(const std::vector<double> &offsets) { offsets_ = offsets; }
  const std::vector<double> &start_offsets() const { return offsets_n_; }
  const std::vector<double> &last_increments() const { return last_increments_; }
  /// Sets the trial state to the start of the step.
  void restart() { offsets_ = offsets_n_; }
  /// Makes the trial state the start of the next step.
  void commit();

  /// Returns the tools whose offsets are unknown in this step.
  const std::vector<std::size_t> &unknown() const { return unknown_; }
  void choose_unknown(const std::vector<std::size_t> &tools);
  /// Fixes the tools while a residual of displacements alone is computed; ...
  void leave_in_place() { unknown_.clear(); }
  /// ... then makes those of the last choose_unknown() unknown again.
  void free_again(const std::vector<std::size_t> &tools) { unknown_ = tools; }
  /// Returns the vector of displacements and unknown offsets.
  Vector pack(const Vector &displacements, const std::vector<double> &offsets) const;
  /// Takes displacements and unknown offsets from such a vector. Collective.
  void unpack(const Vector &x, Vector &displacements);
  /// Adds the residuals of the unknown tools at time t.
  void add_residual(double t, std::size_t n_displacements, Vector &residual) const;

  Placement place(std::size_t tool, double t, double offset) const;
  /// Returns the placements of all tools with the trial offsets.
  std::vector<Placement> placements(double t) const;
  /// Sets the placements of the contacts' tools accordingly.
  void place_contacts(double t);
  bool is_stopped(const std::size_t tool) const { return stopped_[tool] != nullptr; }
  void stop(const std::size_t tool, const Placement &at) { stopped_[tool] = std::make_unique<Placement>(at); }
  /// Returns the tools that exert their stop force at time t. Collective.
  std::vector<std::size_t> find_stopping(double t, const std::function<bool(std::size_t)> &is_removed) const;

  /// Returns the factor from the offset to the unknown.
  double unit_of(std::size_t tool) const;
  ToolRate rate_of(std::size_t tool) const;
  /// Returns the load that the tool exerts along its direction, or about its axis. Collective.
  double exerted_load(std::size_t tool) const;
  /// Returns the residual of a tool, with its inertia if it has a mass. Collective.
  double imbalance(std::size_t tool, double t) const;
  /// Returns the distance between the tool and the bodies; infinite if it cannot touch them.
  /// Collective.
  double distance_to_touch(std::size_t tool) const;

  /// Assembles B, C and D, after the contacts' update(). Collective.
  void assemble_tangent();
  /// Solves K x = b. Returns false on failure.
  using Solve = std::function<bool(const Vector &b, double relative_tolerance, Vector &x)>;
  /// Solves the bordered system by elimination of du. A tool without contact moves until it
  /// touches. `sense` is 1 if the solution is added to the unknowns, −1 if it is subtracted.
  bool solve(const Solve &solve, const Vector &r_u, const std::vector<double> &r_s, double sense,
             double relative_tolerance, Vector &du, std::vector<double> &ds);
  /// Returns the reason of the last failure of solve(); empty if no tool caused it.
  const std::string &failure() const { return failure_; }
  void clear_failure() { failure_.clear(); }

  // To and from the group of a tool:
  void save(std::size_t tool, const Placement &at, StateWriter &writer) const;
  void load(std::size_t tool, StateReader &reader, const Placement &at);
  /// Prepares load().
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
  Vector layout_; ///< zeros: displacements and unknown offsets
  /// Placements of tools that have stopped permanently.
  std::vector<std::unique_ptr<Placement>> stopped_;
  Border border_;
  std::string failure_;
};

} // namespace billet

#endif
