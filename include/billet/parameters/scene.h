// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_SCENE_H
#define BILLET_PARAMETERS_SCENE_H

#include "billet/diagnostics.h"
#include "billet/parameters/body.h"
#include "billet/parameters/control.h"
#include "billet/parameters/implicit_dynamics.h"
#include "billet/parameters/probe.h"
#include "billet/parameters/profile.h"
#include "billet/parameters/tool.h"

#include <iosfwd>

namespace billet::parameters {

/// Contents of a scene file, with every value checked and references between names resolved.
struct Scene {
  std::string title;
  std::string file_name;
  std::string text; ///< the file as read
  std::string profile;
  double target_error = 0.; ///< relative to the forces, of all sources but the mesh; 0: none
  MeshTarget mesh_target;   ///< in addition to it
  bool warnings_are_errors = false;
  std::vector<Preset> presets; ///< parameters that the profile or the target error has set
  DiagnosticList warnings;     ///< about old names of parameters
  std::vector<Amplitude> amplitudes;
  std::vector<Body> bodies;
  std::vector<Tool> tools;
  std::vector<ContactPair> pairs;
  std::vector<Probe> probes;
  TimeStepping time_stepping;
  ExplicitDynamics explicit_dynamics;
  ImplicitDynamics implicit_dynamics;
  Solver solver;
  Output output;
  Restart restart;

  Scene();
  Scene(const Scene &);
  Scene(Scene &&) noexcept;
  Scene &operator=(const Scene &);
  Scene &operator=(Scene &&) noexcept;
  ~Scene();

  /// Reads a scene file. `restart_file`, unless it is empty, replaces the scene's own; `settings`
  /// from the command line override the file. Throws InputError.
  static Scene read(const std::string &file_name, const std::string &restart_file = "",
                    const std::vector<SceneFile::Setting> &settings = {});
  static Scene read(SceneFile file, const std::string &restart_file);

  const SchemeType &scheme() const { return type_of(time_stepping.scheme); }
  /// Returns the whole target error, and how much of it is left to the mesh: "5 % (3.3 % for the
  /// mesh)".
  std::string print_target() const;
  /// Returns the time over which a support or load fades if it has no 'Fade time' [time].
  double automatic_fade_time() const;
  std::size_t body_index(const ContactPair &pair) const;
  std::size_t second_body_index(const ContactPair &pair) const;
  std::size_t tool_index(const ContactPair &pair) const;
  std::size_t body_index(const Probe &probe) const;
};

/// Refuses pairs that would apply contact forces twice between the same faces, or a face and a
/// tool. Pairs with names count only if their ids are known.
void check_repeated_pairs(const std::vector<ContactPair> &pairs, bool names_are_known);

/// Prints every parameter with its default, range, unit and meaning.
void print_all_parameters(std::ostream &stream);

/// Prints all parameters as a JSON Schema (draft 7) of a scene written as JSON, with an object for
/// each subsection.
void print_schema(std::ostream &stream);

} // namespace billet::parameters

#endif
