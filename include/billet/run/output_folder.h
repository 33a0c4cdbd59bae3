// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_OUTPUT_FOLDER_H
#define BILLET_RUN_OUTPUT_FOLDER_H

#include "billet/parameters/scene.h"

namespace billet {

/// Treatment of results of an earlier run in the output folder.
enum class EarlierResults {
  moved_aside, ///< the folder is renamed FOLDER.1, or FOLDER with the lowest free number
  replaced,    ///< the new run writes over them; its checkpoints and fields are removed
  continued    ///< the new run resumes from a checkpoint among them
};

/// Name of the file in the output folder with all that the console shows.
constexpr const char *log_file = "billet.log";

/// Whether a file in an output folder has a name that runs give to their results. The copy of the
/// scene is none of them, see scene_copy().
bool is_name_of_result(const std::string &name);

/// Whether a run has left its results in this folder.
bool has_results(const std::string &folder);

/// Returns the file of the copy of the scene in the output folder. It is 'scene.prm', unless that
/// is a file of the user: one that the scene is made of, or that stood there before any results.
/// Then, and in all later runs, the copy is 'scene_as_run.prm'.
std::string scene_copy(const parameters::Scene &parameters);

/// Returns the file of the copy that a run has left in a folder.
std::string left_copy(const std::string &folder);

/// Throws InputError if the scene's output folder does not exist and cannot be made, is not
/// writable, or is in use by another run. It also throws if the folder has results that would have
/// to be moved aside but cannot be. Files in the folder that the scene is made of and that results
/// would replace are an error, too.
void check_output_folder(const parameters::Scene &parameters, EarlierResults earlier);

/// Moves earlier results aside, or removes checkpoints and fields, if they are to be, and makes the
/// folder. Returns the name that the results have now; empty if none were moved. First rank only.
/// Throws InputError on failure.
std::string prepare_output_folder(const parameters::Scene &parameters, EarlierResults earlier);

/// Writes a copy of the scene as read into the folder, which it makes if necessary. First rank
/// only. Throws InputError on failure.
void write_scene(const parameters::Scene &parameters);

} // namespace billet

#endif
