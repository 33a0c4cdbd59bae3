// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/libraries.h"

#include "billet/errors.h"
#include "billet/version.h"

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <dlfcn.h>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace billet::parameters {

const char libraries_key[] = "Libraries";

namespace {

/// Returns the function of a library; null if it has none of this name.
template <class Function> Function *find_function(void *library, const char *name) {
  return reinterpret_cast<Function *>(dlsym(library, name)); // POSIX allows this conversion
}

/// Loads a library and registers its types. `origin`: where the scene names it.
void load_library(const std::string &name, const std::string &origin) {
  std::error_code no_file;
  const std::filesystem::path path = std::filesystem::canonical(name, no_file);
  if (no_file)
    throw InputError(origin + " names '" + name +
                     "', and there is no such file; allowed is a shared library");
  static std::vector<std::filesystem::path> loaded;
  if (std::find(loaded.begin(), loaded.end(), path) != loaded.end())
    return;
  void *const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char *const reason = dlerror();
    throw InputError(origin + ": the system cannot load '" + name + "': " + (reason ? reason : "no reason"));
  }
  const auto version = find_function<const char *()>(library, "billet_plugin_version");
  const auto register_types = find_function<void()>(library, "billet_plugin_register");
  if (version == nullptr || register_types == nullptr) {
    dlclose(library);
    throw InputError(origin + ": '" + name +
                     "' has no BILLET_PLUGIN; allowed is a library built with billet/plugin.h");
  }
  if (std::string(version()) != build_name) {
    const std::string other = version();
    dlclose(library);
    throw InputError(origin + ": '" + name + "' was built for billet " + other + ", and this is " +
                     build_name + "; build the library again with the files of this version");
  }
  try {
    register_types();
  } catch (const std::exception &error) {
    // Types that it has registered stay: the library stays loaded.
    throw InputError(origin + ": '" + name + "' cannot register its types: " + error.what());
  }
  loaded.push_back(path);
}

} // namespace

void load_libraries(const SceneFile &file) {
  const std::string names = file.value({}, libraries_key, "");
  for (const std::string &name : dealii::Utilities::split_string_list(names, ';'))
    if (!name.empty())
      load_library(file.resolve({}, libraries_key, name),
                   file.where({}, libraries_key) + ": '" + libraries_key + "'");
}

} // namespace billet::parameters
