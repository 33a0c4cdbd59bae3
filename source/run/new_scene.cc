// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/new_scene.h"

#include "billet/errors.h"
#include "billet/nearest_name.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace billet {

std::string write_new_scene(const std::string &name, const std::string &file) {
  const auto &all = scene_templates();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const SceneTemplate &candidate) { return candidate.name == name; });
  if (found == all.end()) {
    std::vector<std::string> known;
    std::string list;
    for (const SceneTemplate &one : all) {
      known.push_back(one.name);
      list += (list.empty() ? "" : ", ") + one.name;
    }
    throw InputError("command line: '--new' names '" + name + "'; allowed is one of: " + list +
                     did_you_mean(name, known));
  }
  const std::string target = file.empty() ? name + ".prm" : file;
  if (std::filesystem::exists(std::filesystem::symlink_status(target)))
    throw InputError("command line: '" + target +
                     "' exists, and '--new' replaces no file; allowed is another "
                     "name, as in 'billet --new " +
                     name + " my_" + name + ".prm'");
  std::ofstream stream(target, std::ios::binary);
  stream << found->text;
  stream.close();
  if (!stream)
    throw InputError("command line: '" + target +
                     "' cannot be written; allowed is the name of a writable file");
  return target;
}

} // namespace billet
