// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/shipped.h"

#include <filesystem>

namespace billet {

std::string find_shipped(const std::vector<std::string> &places) {
  namespace fs = std::filesystem;
  std::error_code error;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path(); folder.has_relative_path();
       folder = folder.parent_path())
    for (const std::string &place : places)
      if (fs::exists(folder / place, error))
        return (folder / place).string();
  return "";
}

} // namespace billet
