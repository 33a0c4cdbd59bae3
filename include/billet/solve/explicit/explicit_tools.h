// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_TOOLS_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_TOOLS_H

#include "billet/contact/contacts.h"
#include "billet/solve/explicit/explicit_clock.h"
#include "billet/solve/explicit/explicit_elements.h"
#include "billet/solve/explicit/free_tool.h"
#include "billet/solve/explicit/nodal_rows.h"

#include <memory>
#include <optional>
#include <vector>

namespace billet {

/// All tools of an explicit scene: their motion, their loads on the bodies, and their removal. The
/// forces of a removed tool fade over its release time.
class ExplicitTools {
public:
  ExplicitTools(const Scene &scene, const LocalNodes &nodes);

  std::size_t size() const { return tools_.size(); }
  const FreeTool &operator[](const std::size_t tool) const { return tools_[tool]; }
  /// Whether any tool moves within this time from the start.
  bool move_within(double time) const;
  /// Return the placements at the start of the step that ends now, and at its end.
  std::vector<Placement> placements_before() const { return placements(&FreeTool::before); }
  std::vector<Placement> placements_now() const { return placements(&FreeTool::now); }

  /// Sets all loads to 0, before forces are computed.
  void clear_loads();
  /// Adds the load of a contact with a tool, on this rank.
  void add_load(const ContactInterface &contact, std::size_t tool, const ContactLoad &load);
  /// Returns the load on the bodies at t_n, on this rank.
  const ContactLoad &load(const std::size_t tool) const { return loads_[tool]; }
  /// Returns the same for a pair of Scene::pairs().
  const ContactLoad &pair_load(const std::size_t pair) const { return pair_loads_[pair]; }
  /// Whether forces of a removed tool are left at t.
  bool is_fading(std::size_t tool, double t) const;
  /// Returns what is left at t of a removed tool's load, on this rank at these displacements:
  /// through this pair, or through all.
  ContactLoad fading_load(std::size_t tool, double t, const NodalVectors &displacements,
                          std::optional<std::size_t> pair = {}) const;
  /// Returns the addition of the free tools' masses to ω² of the contacts [1/time²]. Collective.
  double max_frequency_square() const;

  /// Removes tools that are due from their contacts, after a step to t. Their forces of the last
  /// update fade from there on, and a checkpoint has them. Their energies leave `external_work`.
  void remove_due(double t, Contacts &contacts, double &external_work);
  /// Adds what is left at t of removed tools' forces at these nodes.
  void add_fading(double t, const std::vector<unsigned int> &nodes, NodalVectors &forces) const;
  /// Changes the velocities of free tools. Collective.
  void kick(const ExplicitClock &clock);
  /// Moves the tools through the step.
  void move(const ExplicitClock &clock);
  /// Adds works in one half of a step on this rank, at time t [energy].
  void add_works(double t, double &external_work) const;

  // For checkpoints, in the groups of tools.
  /// Forces of removed tools act at these nodes. Collective.
  void save(StateWriter &writer, const NodalRows &rows, const std::vector<unsigned int> &nodes) const;
  /// `is_exact`: of the same method. Tools that the checkpoint does not contain begin at time t.
  void load(StateReader &reader, const NodalRows &rows, bool is_exact, double t);

private:
  std::vector<Placement> placements(const Placement &(FreeTool::*get)() const) const;
  MPI_Comm communicator() const { return nodes_.discretization().communicator(); }
  void remove(std::size_t tool, Contacts &contacts, double &external_work);
  void save_fading(StateWriter &writer, std::size_t tool, const NodalRows &rows,
                   const std::vector<unsigned int> &nodes) const;
  void load_fading(const StateReader &reader, std::size_t tool, const NodalRows &rows, bool is_exact);

  /// Forces of a removed tool at its removal, of this rank.
  struct Removed {
    std::optional<std::size_t> pair; ///< index in Scene::pairs(); none: of another scene
    NodalVectors forces;
  };

  const Scene &scene_;
  const LocalNodes &nodes_;
  std::vector<FreeTool> tools_;
  std::vector<ContactLoad> loads_, pair_loads_; ///< at t_n, of this rank
  std::vector<double> stiffness_;               ///< against free tools, of this rank
  bool has_free_tools_;
  std::vector<std::unique_ptr<std::vector<Removed>>> fading_forces_; ///< by tool; null: not removed
  HeldMemory memory_{Capability::driven_tools};
};

} // namespace billet

#endif
