// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_RESUMPTION_H
#define BILLET_RUN_RESUMPTION_H

#include "billet/discretization/discretization.h"
#include "billet/output/checkpoint.h"
#include "billet/scene/scene.h"
#include "billet/solve/refined_reader.h"
#include "billet/solve/restart.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Thrown on all ranks if the checkpoint is from the end of the scene that resumes from it.
struct AlreadyComplete {
  Diagnostic diagnostic;
};

/// Refinement of some bodies in the course of a run.
struct MeshChange {
  MeshLevels levels;            ///< after it
  std::vector<bool> is_refined; ///< by body
  double time;
  std::string text;         ///< names of the bodies and numbers of their elements, for messages
  EnergyLedger before = {}; ///< at this time on the coarser mesh

  /// Maximum energy that contact springs may gain, as a part of all energy before. New nodes lie on
  /// the chords of faces, which a curved surface lets penetrate: springs then push bodies apart.
  static constexpr double max_gain = 0.01;
  /// Maximum change of all energy, as a part of it. Finer elements resist strains that coarse ones
  /// let pass: bent bodies change theirs by up to a half and still gain accuracy.
  static constexpr double max_change = 1.;
  /// Throws SolutionFailure if the energies change by more on the finer mesh.
  void check(const std::string &scene_name, double energy_change, const EnergyLedger &after) const;
  /// Returns a message about the change. It includes unbalanced forces above this relative
  /// tolerance.
  Diagnostic describe(const RestartReport &report, double force_tolerance) const;
};

/// Start of a run from a checkpoint, in place of time 0, or from the state of a run on a coarser
/// mesh.
class Resumption {
public:
  /// Opens the checkpoint that the scene names; returns null if it names none. Throws InputError if
  /// the file is no valid checkpoint. Collective.
  static std::unique_ptr<Resumption> open(const parameters::Scene &parameters, MPI_Comm communicator);
  /// Opens the state of a run with save_mesh() in its group "mesh", for a run after this change.
  /// Collective.
  Resumption(const std::string &file_name, MPI_Comm communicator, MeshChange change);

  /// Returns the state for the mesh of the run: that of the checkpoint, after load() of the mesh
  /// that replaces it.
  StateReader &state() { return refined_ ? static_cast<StateReader &>(*refined_) : file_; }
  /// Calls `load` inside a group of the state. Throws InputError as CheckpointReader::load().
  void in(const std::string &group, const std::function<void()> &load);
  const RestartReport &report() const { return report_; }
  /// Returns the refinement levels of the run's bodies. Throws InputError if the checkpoint's mesh
  /// is finer than that of the scene.
  MeshLevels find_levels(const Scene &scene);
  /// Whether the run continues another one, which has ended at this time, on a finer mesh.
  bool is_refinement() const { return change_.has_value(); }
  const MeshChange &change() const { return *change_; }

  /// Whether the checkpoint is in this folder; then the run continues the files there.
  bool is_from(const std::string &folder) const;
  /// Checks the scene against the checkpoint and calls `load`, which reads the solution and returns
  /// the report. Throws InputError if the scene does not fit, AlreadyComplete if nothing remains to
  /// be computed.
  void load(const Scene &scene, const Discretization &discretization,
            const std::function<RestartReport()> &load);
  /// Returns a message about time and changes of the scene. It includes unbalanced forces above
  /// this relative tolerance.
  Diagnostic describe(double force_tolerance) const;

private:
  Resumption(MPI_Comm communicator, const std::string &file_name, const std::string &origin);
  /// Throws what load() throws about the end time.
  void check_end(const parameters::Scene &parameters) const;

  CheckpointReader file_;
  std::optional<MeshChange> change_;
  std::unique_ptr<RefinedReader> refined_;
  RestartReport report_;
};

} // namespace billet

#endif
