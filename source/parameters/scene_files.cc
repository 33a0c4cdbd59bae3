// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/scene_files.h"

#include "billet/errors.h"

#include <filesystem>
#include <sstream>

namespace billet::parameters {

namespace {

/// Adds the files that entries name. A value of any other meaning is the name of a file by chance
/// only.
void add_named_files(const SceneFile &scene, std::vector<std::string> &files) {
  for (const SceneFile::Entry &entry : scene.entries()) {
    const std::string file = scene.resolve(entry.path, entry.key, entry.value);
    std::error_code error;
    if (entry.path != SceneFile::Path{"Restart"} && std::filesystem::is_regular_file(file, error))
      files.push_back(file);
  }
}

} // namespace

std::vector<std::string> find_files(const Scene &scene) {
  std::vector<std::string> files = {scene.file_name};
  try {
    const SceneFile written = SceneFile::read(scene.file_name);
    const auto add_file_of = [&files](const std::string &where) {
      files.push_back(where.substr(0, where.rfind(':')));
    };
    for (const SceneFile::Entry &entry : written.entries())
      add_file_of(entry.where);
    for (const SceneFile::Path &path : written.paths())
      add_file_of(written.where(path));
    add_named_files(written, files);
    std::istringstream as_read(scene.text); // with what the command line sets
    add_named_files(SceneFile::scan(as_read, scene.file_name), files);
  } catch (const InputError &) { // the file has changed, or was never there
  }
  return files;
}

} // namespace billet::parameters
