// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_TOOL_REMOVAL_H
#define BILLET_SOLVE_IMPLICIT_TOOL_REMOVAL_H

#include "billet/solve/implicit/contact_set.h"
#include "billet/solve/implicit/dead_forces.h"
#include "billet/solve/restart.h"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace billet {

/// Forces of a removed tool at its removal, through one of its pairs.
struct RemovedForces {
  std::size_t tool;
  std::optional<std::size_t> pair; ///< index in Scene::pairs(); none: of another scene
  DeadForces forces;
};

/// Removal of tools at given times: the forces by which they held the bodies fade over their
/// release time.
class ToolRemoval {
public:
  ToolRemoval(const Scene &scene, const Discretization &discretization, ContactSet &contacts)
      : scene_(scene), discretization_(discretization), contacts_(contacts), forces_(scene.tools().size()) {}

  bool is_removed(const std::size_t tool) const { return forces_[tool] != nullptr; }
  /// Returns the part of its forces that is left at t.
  double fading(double t, std::size_t tool) const;
  /// Whether the remaining forces of any tool differ between t and t_n.
  bool changes(double t_n, double t) const;
  /// Adds the remaining forces at t.
  void add_forces(double t, Vector &residual) const;
  /// Returns their work from t_n to t.
  double work(double t_n, double t, const Vector &increment) const;

  /// Tools that are removed at a time.
  struct Removal {
    std::vector<std::size_t> tools;
    /// Names of the tools that each body loses.
    std::map<std::size_t, std::set<std::string>> let_go;
  };
  /// Removes the tools that are due at t from their contacts. Collective.
  Removal remove_due(double t);
  /// Returns the residual of a removed tool's forces at the removal.
  Vector forces(std::size_t tool) const;
  /// Calls visit(forces, part that is left at t) for the forces of removed tools.
  template <class Visit> void visit_fading(const double t, const Visit &visit) const {
    for (std::size_t tool = 0; tool < forces_.size(); ++tool)
      if (forces_[tool])
        if (const double left = fading(t, tool); left > 0.)
          for (const RemovedForces &removed : *forces_[tool])
            visit(removed, left);
  }

  // To and from the group of a tool:
  void save(std::size_t tool, StateWriter &writer, const OwnedNodes &nodes) const;
  void load(std::size_t tool, StateReader &reader, const OwnedNodes &nodes);

private:
  const Scene &scene_;
  const Discretization &discretization_;
  ContactSet &contacts_;
  std::vector<std::unique_ptr<std::vector<RemovedForces>>> forces_; ///< by tool; null: not removed
};

/// Forces that are out of balance when a run resumes from another scheme's state, or with other
/// tools. They fade to zero.
class ReleasedForces {
public:
  bool are_there() const { return forces_ != nullptr; }
  /// Returns the part of them that is left at t.
  double left(double t) const;
  double end() const { return end_; }
  /// Makes the residual at time t the forces that fade.
  void hold(const Vector &residual, double t);
  void clear() {
    forces_.reset();
    are_of_refinement_ = false;
  }
  /// Whether they are the imbalance of a finer mesh, whose work is none of the model.
  bool are_of_refinement() const { return are_of_refinement_; }
  void are_of_refinement(const bool are) { are_of_refinement_ = are; }
  void fade_until(const double end) { end_ = end; }
  double begin() const { return begin_; }
  /// Subtracts the remaining residual at t.
  void add_forces(double t, Vector &residual) const;
  /// Returns the work that they take from t_n to t, the negative of the work that they do.
  double work(double t_n, double t, const Vector &increment) const;

  void save(StateWriter &writer, const OwnedNodes &nodes) const;
  void load(StateReader &reader, const OwnedNodes &nodes, const Discretization &discretization);

private:
  std::unique_ptr<Vector> forces_; ///< residual at the start, on free dofs; or null
  double begin_ = 0., end_ = 0.;
  bool are_of_refinement_ = false;
};

} // namespace billet

#endif
