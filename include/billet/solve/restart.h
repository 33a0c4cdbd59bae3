// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_RESTART_H
#define BILLET_SOLVE_RESTART_H

#include "billet/contact/contact_interface.h"
#include "billet/discretization/node_keys.h"
#include "billet/mechanics/explicit_block.h"
#include "billet/solve/solution.h"
#include "billet/state.h"

#include <functional>
#include <optional>

namespace billet {

// What the solution methods share when they give their state to a checkpoint and take it back.

/// What a restart found, besides the state that it goes on with.
struct RestartReport {
  double time = 0.;
  bool is_exact = true;          ///< as if there had been no interruption
  double kinetic_energy = 0.;    ///< that a static scene leaves behind [energy]
  double imbalance = 0.;         ///< forces out of balance, which fade from now on [force]
  double release_end = 0.;       ///< when they have gone
  double force_scale = 0.;       ///< what they are small against [force]
  std::vector<std::string> gone; ///< tools and pairs that this scene has no more
};

/// What must not differ between the scene that wrote and the one that goes on: bodies, their meshes and the
/// kinds of their materials.
void save_scene(StateWriter &writer, const Scene &scene, const Discretization &discretization);
/// Throws InputError, which names what differs.
void check_scene(StateReader &reader, const Scene &scene, const Discretization &discretization);

/// The nodes whose dofs this rank owns, with their keys.
struct OwnedNodes {
  OwnedNodes(const Discretization &discretization, const NodeKeys &node_keys);

  std::vector<DofIndex> first_dofs;
  std::vector<std::uint64_t> keys;
};
void save_nodal(StateWriter &writer, const std::string &name, const OwnedNodes &nodes, const Vector &values);
/// Into a vector of owned entries.
void load_nodal(const StateReader &reader, const std::string &name, const OwnedNodes &nodes, Vector &values);

/// Of the elements of a body that this rank owns.
std::vector<std::uint64_t> element_keys(const Discretization &discretization, std::size_t body);

/// Axes of a body's elements through the thickness, where it has more than two points along them.
void save_thickness_axes(StateWriter &writer, const ElementBlock &block,
                         const std::vector<std::uint64_t> &keys);
std::vector<ThicknessAxis> load_thickness_axes(const StateReader &reader,
                                               const std::vector<std::uint64_t> &keys);

/// From the group of a body at hand, whichever formulation has written it: the stress that its history means
/// at these displacements (ghosted).
std::vector<ElementStress> load_stress(const StateReader &reader, const Scene &scene, std::size_t body,
                                       const Discretization &discretization, const Vector &displacements);

/// Index among the groups "KIND 0", "KIND 1", ... of the one with this name; none if there is none.
std::optional<std::size_t> find_group(StateReader &reader, const std::string &kind, const std::string &name);
/// Names of these groups.
std::vector<std::string> group_names(StateReader &reader, const std::string &kind);
inline std::string group(const std::string &kind, const std::size_t index) {
  return kind + " " + std::to_string(index);
}

/// Tells which of the checkpoint's tools and pairs are not in the scene, and whether all are the same.
void compare_parts(StateReader &reader, const Scene &scene, RestartReport &report);
/// Writes what names a pair in its group.
void save_pair(StateWriter &writer, const ContactInterface &contact);
/// Calls load() in the group of the pair of this name, and checks that it keeps its partners, else
/// InputError; false without such a pair.
bool load_pair(StateReader &reader, const ContactInterface &contact, const std::function<void()> &load);

std::vector<double> to_numbers(const Placement &placement);
Placement to_placement(const std::vector<double> &numbers);
std::vector<double> to_numbers(const ContactLoad &load);
ContactLoad to_contact_load(const std::vector<double> &numbers);
std::vector<double> to_numbers(const EnergyLedger &energies);
EnergyLedger to_energies(const std::vector<double> &numbers);

/// Forces of a removed tool on the bodies, which may have parts on several ranks: rows that each rank gives
/// under its own keys, and their sum at each of these nodes, from any number of ranks.
void save_parts(StateWriter &writer, const std::string &name, unsigned int rank,
                const std::vector<std::uint64_t> &keys, const std::vector<double> &values);
std::vector<double> load_sums(const StateReader &reader, const std::string &name,
                              const std::vector<std::uint64_t> &keys);
/// The part of this rank, where there were as many ranks as now.
std::vector<double> load_part(const StateReader &reader, const std::string &name, unsigned int rank,
                              const std::vector<std::uint64_t> &keys);

} // namespace billet

#endif
