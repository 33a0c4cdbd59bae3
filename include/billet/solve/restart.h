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

// Functions that the solution methods share to write their state to a checkpoint and read it.

/// Findings of a restart, beside the state itself.
struct RestartReport {
  double time = 0.;
  bool is_exact = true;       ///< as if the run had not been interrupted
  double kinetic_energy = 0.; ///< lost when a static scene starts [energy]
  /// Forces out of balance, which fade from the restart on [force].
  double imbalance = 0.;
  double release_end = 0.;          ///< time at which they have faded
  double force_scale = 0.;          ///< reference value of the imbalance [force]
  double energy_change = 0.;        ///< by other elements or another scheme [energy]
  std::vector<std::string> gone;    ///< tools and pairs that this scene no longer has
  std::vector<std::string> changed; ///< parameters of materials with another value now
};

/// Returns which bodies' elements are those of the state, each divided into eight; empty if the
/// mesh is that of the state. See RefinedReader.
std::vector<bool> refined_bodies(const StateReader &reader);
/// Returns whether a contact pair has such a body.
bool is_refined(const StateReader &reader, const ContactInterface &contact);

/// Returns the time over which unbalanced forces, and gaps of a coarser mesh, fade after a
/// refinement.
double refinement_release_time(const parameters::Scene &parameters);
/// Returns when gaps of a coarser mesh have faded that a refinement at this time makes finer, (R7)
/// of doc/theory.
double end_of_fading(const parameters::Scene &parameters, double time);

/// Saves the properties that must agree between the scenes before and after a restart: bodies,
/// their meshes and the kinds of their materials.
void save_scene(StateWriter &writer, const Scene &scene, const Discretization &discretization);
/// Checks these properties. Throws InputError that names the difference. Returns the parameters of
/// materials that have another value now: "'Yield stress' of body 'cube' (300, now 900)".
std::vector<std::string> check_scene(StateReader &reader, const Scene &scene,
                                     const Discretization &discretization);
/// Returns the refinement levels of the bodies of the state. Throws InputError if they exceed those
/// of the scene at this time.
MeshLevels load_levels(StateReader &reader, const Scene &scene, double time);

/// Nodes whose dofs this rank owns, with their keys.
struct OwnedNodes {
  OwnedNodes(const Discretization &discretization, const NodeKeys &node_keys);

  std::vector<DofIndex> first_dofs;
  std::vector<std::uint64_t> keys;
};
void save_nodal(StateWriter &writer, const std::string &name, const OwnedNodes &nodes, const Vector &values);
/// Reads values into a vector of owned entries.
void load_nodal(const StateReader &reader, const std::string &name, const OwnedNodes &nodes, Vector &values);

/// Returns the keys of the elements of a body that this rank owns.
std::vector<std::uint64_t> element_keys(const Discretization &discretization, std::size_t body);

/// Saves the axes of a body's elements through the thickness, if they have more than two points
/// along them.
void save_thickness_axes(StateWriter &writer, const ElementBlock &block,
                         const std::vector<std::uint64_t> &keys);
std::vector<ThicknessAxis> load_thickness_axes(const StateReader &reader,
                                               const std::vector<std::uint64_t> &keys);

/// Meaning of the numbers of a body's history.
struct HistoryFormat {
  std::string method; ///< implicit or explicit
  std::string element, elasticity, number_type;
  unsigned int points_through;
  std::vector<double> constants; ///< of the element

  bool operator==(const HistoryFormat &other) const {
    return method == other.method && element == other.element && elasticity == other.elasticity &&
           number_type == other.number_type && points_through == other.points_through &&
           constants == other.constants;
  }
  bool operator!=(const HistoryFormat &other) const { return !(*this == other); }
};
HistoryFormat format_of(const ElementFormulation &formulation, const PointLaw &law);
HistoryFormat format_of(const ExplicitFormulation &formulation, const PointLaw &law);
void save_format(StateWriter &writer, const HistoryFormat &format);
HistoryFormat load_format(const StateReader &reader);

/// Saves the names of the fields of a law's state, beside the histories that have them.
void save_fields(StateWriter &writer, const PointLaw &law);
/// Reads the histories of a body's elements, which have the states of the law at `points`. Orders
/// the fields of these states by name as the law has them. Throws InputError if the fields differ.
std::vector<double> load_history(const StateReader &reader, const std::string &body, const PointLaw &law,
                                 const PointStates &points, std::size_t width,
                                 const std::vector<std::uint64_t> &keys);

/// Returns the stresses of a body that its saved history implies at these displacements (ghosted)
/// and at the temperature of time t. Reads the current group, which any formulation may have
/// written.
std::vector<ElementStress> load_stress(const StateReader &reader, const Scene &scene, std::size_t body,
                                       const Discretization &discretization, const Vector &displacements,
                                       double t);

/// Returns the index, among the groups "KIND 0", "KIND 1", ..., of the one with this name; none if
/// there is none.
std::optional<std::size_t> find_group(StateReader &reader, const std::string &kind, const std::string &name);
/// Returns the names of these groups.
std::vector<std::string> group_names(StateReader &reader, const std::string &kind);
inline std::string group(const std::string &kind, const std::size_t index) {
  return kind + " " + std::to_string(index);
}

/// Adds to the report the checkpoint's tools and pairs that are not in the scene, and whether all
/// are the same.
void compare_parts(StateReader &reader, const Scene &scene, RestartReport &report);
/// Writes the name and partners of a pair to its group.
void save_pair(StateWriter &writer, const ContactInterface &contact);
/// Calls load() in the group of the pair of this name. Throws InputError if its partners differ.
/// Returns false if there is no such pair.
bool load_pair(StateReader &reader, const ContactInterface &contact, const std::function<void()> &load);

std::vector<double> to_numbers(const Placement &placement);
Placement to_placement(const std::vector<double> &numbers);
std::vector<double> to_numbers(const ContactLoad &load);
ContactLoad to_contact_load(const std::vector<double> &numbers);
std::vector<double> to_numbers(const EnergyLedger &energies);
EnergyLedger to_energies(const std::vector<double> &numbers);

/// Saves the forces of a removed tool on the bodies in rows under keys of each rank. A node may
/// have parts on several ranks. load_sums() returns the sums at these nodes, from any number of
/// ranks.
void save_parts(StateWriter &writer, const std::string &name, unsigned int rank,
                const std::vector<std::uint64_t> &keys, const std::vector<double> &values);
std::vector<double> load_sums(const StateReader &reader, const std::string &name,
                              const std::vector<std::uint64_t> &keys);
/// Reads the part of this rank, if there were as many ranks as now.
std::vector<double> load_part(const StateReader &reader, const std::string &name, unsigned int rank,
                              const std::vector<std::uint64_t> &keys);

/// Saves where nodes were when supports began, at these times: `save` writes the displacements
/// under a name.
void save_support_starts(StateWriter &writer, const std::set<double> &times,
                         const std::function<void(const std::string &name, double time)> &save);
/// Calls `load` for those of the times that the state knows. Returns the others.
std::set<double> load_support_starts(const StateReader &reader, const std::set<double> &times,
                                     const std::function<void(const std::string &name, double time)> &load);

/// Time from which the force of a support fades, and over which.
struct FadeTimes {
  double begin, duration;

  double end() const { return begin + duration; }
  /// Returns the part that is left at t; `duration` is > 0.
  double left(const double t) const { return t >= end() ? 0. : 1. - (t - begin) / duration; }
};
/// Saves fading forces of supports: `save` writes those of an index under a name.
void save_support_fades(StateWriter &writer, const std::vector<FadeTimes> &times,
                        const std::function<void(const std::string &name, std::size_t index)> &save);
/// Calls `load` for each of them.
void load_support_fades(const StateReader &reader,
                        const std::function<void(const std::string &name, const FadeTimes &times)> &load);

} // namespace billet

#endif
