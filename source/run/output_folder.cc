// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/output_folder.h"

#include "billet/errors.h"

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace billet {

void check_output_folder(const parameters::Scene &parameters) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path folder = fs::absolute(parameters.output.folder.value, error);
  while (!fs::exists(folder, error) && folder.has_relative_path())
    folder = folder.parent_path();
  if (!fs::is_directory(folder, error) || access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(parameters.output.folder.origin + " is '" + parameters.output.folder.value +
                     "'; allowed is a folder that the program can create and write to; '" + folder.string() +
                     "' is " + (fs::is_directory(folder, error) ? "not writable" : "not a folder"));
  for (const std::string name : {"scene.prm", "history.csv"}) {
    const fs::path file = fs::path(parameters.output.folder.value) / name;
    if (fs::exists(file, error) && (fs::is_directory(file, error) || access(file.c_str(), W_OK) != 0))
      throw InputError(parameters.output.folder.origin + " is '" + parameters.output.folder.value +
                       "'; allowed is a folder that the program can create and write to; '" + file.string() +
                       "' cannot be overwritten");
  }
}

void prepare_output_folder(const parameters::Scene &parameters) {
  const std::filesystem::path folder = parameters.output.folder.value;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::ofstream copy(folder / "scene.prm");
  copy << parameters.text;
  if (error || !copy.flush())
    throw InputError(parameters.output.folder.origin + ": the program cannot write to '" + folder.string() +
                     "'");
}

} // namespace billet
