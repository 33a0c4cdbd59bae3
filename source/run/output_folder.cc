// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/output_folder.h"

#include "billet/errors.h"
#include "billet/output/console_log.h"
#include "billet/parameters/scene_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <regex>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace billet {

namespace {

namespace fs = std::filesystem;

/// Returns the beginning of a message.
std::string quote_folder(const parameters::Scene &parameters) {
  return parameters.output.folder.origin + " is '" + parameters.output.folder.value + "'";
}

/// Whether a folder has one of these files.
bool has_any(const fs::path &folder, const std::initializer_list<const char *> files) {
  std::error_code error;
  return std::any_of(files.begin(), files.end(),
                     [&](const char *file) { return fs::is_regular_file(folder / file, error); });
}

using FileNumber = std::pair<dev_t, ino_t>; ///< device and inode, the same under all names of a file

std::optional<FileNumber> number_of(const fs::path &file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0)
    return {};
  return FileNumber{status.st_dev, status.st_ino};
}

/// Files that a scene is made of, under all their names.
class SourceFiles {
public:
  explicit SourceFiles(const parameters::Scene &parameters) {
    for (const std::string &file : parameters::find_files(parameters))
      if (const auto number = number_of(file))
        numbers_.push_back(*number);
  }
  bool have(const fs::path &file) const {
    const auto number = number_of(file);
    return number && std::find(numbers_.begin(), numbers_.end(), *number) != numbers_.end();
  }

private:
  std::vector<FileNumber> numbers_;
};

/// Whether a file or folder is this folder or anywhere in it.
bool is_inside(const fs::path &file, const fs::path &folder) {
  std::error_code error;
  const fs::path inner = fs::weakly_canonical(file, error), outer = fs::weakly_canonical(folder, error);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

/// Refuses to move a folder away that the run itself needs.
void check_movable(const parameters::Scene &parameters, const fs::path &folder) {
  const auto refuse = [&](const std::string &what) {
    throw InputError(quote_folder(parameters) +
                     ", where an earlier run has left results; they cannot be moved "
                     "aside, since " +
                     what + "; allowed is another folder, or '--force', which replaces them");
  };
  std::error_code error;
  if (is_inside(fs::current_path(error), folder))
    refuse("it holds the current folder");
  if (is_inside(parameters.file_name, folder))
    refuse("it holds the scene file");
  for (const std::string &source : parameters::find_files(parameters))
    if (is_inside(source, folder))
      refuse("it holds '" + source + "', which the scene reads");
  if (parameters.restart.is_wanted() && is_inside(parameters.restart.file.value, folder))
    refuse("it holds the checkpoint from which the run resumes");
  const fs::path parent = fs::weakly_canonical(folder, error).parent_path();
  if (access(parent.c_str(), W_OK | X_OK) != 0)
    refuse("'" + parent.string() + "' is not writable");
}

/// Renames the folder to the one with the lowest free number. Returns the new name.
std::string move_aside(const parameters::Scene &parameters, const fs::path &folder) {
  std::error_code error;
  const fs::path source = fs::is_symlink(folder, error) ? fs::canonical(folder, error) : folder;
  std::string name = source.string();
  while (name.size() > 1 && name.back() == '/')
    name.pop_back();
  for (unsigned int number = 1;; ++number) {
    const std::string target = name + "." + std::to_string(number);
    if (fs::exists(fs::symlink_status(target, error)))
      continue;
    fs::rename(name, target, error);
    if (!error)
      return target;
    // Another run may have taken the number in the meantime.
    if (error != std::errc::directory_not_empty && error != std::errc::file_exists)
      throw InputError(quote_folder(parameters) +
                       ", where an earlier run has left results; they cannot be "
                       "renamed '" +
                       target + "' (" + error.message() +
                       "); allowed is another folder, or '--force', which replaces them");
  }
}

/// Names of checkpoints and fields, of which a shorter run would not write over all, and of lists
/// of fields.
const char *const snapshots =
    "checkpoint_[0-9]{5,10}\\.h5|fields_[0-9]{5,10}(\\.[0-9]+)?\\.(vtm|vtu|pvtu|h5)|"
    "scene\\.pvd|fields\\.xdmf";

/// Names of the copy of the scene: the second where the first is a file of the user.
const char *const first_copy = "scene.prm", *const second_copy = "scene_as_run.prm";

/// Removes checkpoints and fields of an earlier run.
void remove_snapshots(const fs::path &folder) {
  const std::regex snapshot(snapshots);
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto &entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error) && std::regex_match(entry.path().filename().string(), snapshot))
      files.push_back(entry.path());
  for (const fs::path &file : files)
    fs::remove(file, error);
}

/// Refuses a folder with a file of the scene that results would replace.
void check_sources(const parameters::Scene &parameters, const fs::path &folder) {
  const SourceFiles sources(parameters);
  std::error_code error;
  for (const auto &entry : fs::directory_iterator(folder, error))
    if (sources.have(entry.path()) && is_name_of_result(entry.path().filename().string()))
      throw InputError(quote_folder(parameters) + ", where results would replace '" + entry.path().string() +
                       "', which the scene reads; allowed is another folder");
}

[[noreturn]] void refuse_writing(const parameters::Scene &parameters) {
  throw InputError(parameters.output.folder.origin + ": the program cannot write to '" +
                   parameters.output.folder.value + "'");
}

void make_folder(const parameters::Scene &parameters) {
  const fs::path folder = parameters.output.folder.value;
  std::error_code error;
  // The folder behind a symbolic link may have been moved, or was never made.
  fs::create_directories(
      fs::is_symlink(folder, error) ? folder.parent_path() / fs::read_symlink(folder, error) : folder, error);
  if (!fs::is_directory(folder, error))
    refuse_writing(parameters);
}

} // namespace

bool is_name_of_result(const std::string &name) {
  const std::regex results(std::string(snapshots) +
                           "|scene_as_run\\.prm|history(_until_.*)?\\.csv|diagnostics\\.jsonl|billet\\.log|"
                           "(capabilities|error_estimate|mesh_levels)\\.csv|show_in_paraview\\.py|"
                           "refinement\\.h5|scene\\.png(\\.log)?");
  return std::regex_match(name, results);
}

bool has_results(const std::string &folder) {
  return has_any(folder, {"history.csv", "diagnostics.jsonl", log_file});
}

std::string left_copy(const std::string &folder) {
  const fs::path second = fs::path(folder) / second_copy;
  return (fs::exists(second) ? second : fs::path(folder) / first_copy).string();
}

std::string scene_copy(const parameters::Scene &parameters) {
  const fs::path folder = parameters.output.folder.value, copy = folder / first_copy,
                 second = folder / second_copy;
  std::error_code error;
  // The log of this run may have begun.
  const bool is_of_a_run =
      has_any(folder, {"history.csv", "diagnostics.jsonl"}) && !fs::exists(second, error);
  return (!fs::exists(copy, error) || (is_of_a_run && !SourceFiles(parameters).have(copy)) ? copy : second)
      .string();
}

void check_output_folder(const parameters::Scene &parameters, const EarlierResults earlier) {
  std::error_code error;
  const fs::path results = parameters.output.folder.value;
  fs::path folder = fs::absolute(results, error);
  while (!fs::exists(folder, error) && folder.has_relative_path())
    folder = folder.parent_path();
  const std::string allowed = "; allowed is a folder that the program can create and write to; '";
  if (!fs::is_directory(folder, error) || access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(quote_folder(parameters) + allowed + folder.string() + "' is " +
                     (fs::is_directory(folder, error) ? "not writable" : "not a folder"));
  if (is_held_by_a_run((results / log_file).string()))
    throw InputError(quote_folder(parameters) +
                     ", where another run writes its results; allowed is a folder that no other run uses");
  if (earlier == EarlierResults::moved_aside && has_results(results))
    return check_movable(parameters, results);
  check_sources(parameters, results);
  for (const fs::path &file :
       {fs::path(scene_copy(parameters)), results / "history.csv", results / log_file}) {
    if (fs::exists(file, error) && (fs::is_directory(file, error) || access(file.c_str(), W_OK) != 0))
      throw InputError(quote_folder(parameters) + allowed + file.string() + "' cannot be overwritten");
  }
}

std::string prepare_output_folder(const parameters::Scene &parameters, const EarlierResults earlier) {
  const fs::path folder = parameters.output.folder.value;
  std::string moved;
  if (earlier == EarlierResults::moved_aside && has_results(folder)) {
    check_movable(parameters, folder);
    moved = move_aside(parameters, folder);
  }
  if (earlier == EarlierResults::replaced && has_results(folder))
    remove_snapshots(folder);
  make_folder(parameters);
  return moved;
}

void write_scene(const parameters::Scene &parameters) {
  make_folder(parameters);
  std::ofstream copy(scene_copy(parameters));
  copy << parameters.text;
  if (!copy.flush())
    refuse_writing(parameters);
}

} // namespace billet
