// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_MISSING_END_H
#define BILLET_PARAMETERS_MISSING_END_H

#include "billet/parameters/scene_file.h"

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Statement that opens or closes a subsection, or sets a parameter.
struct Statement {
  enum class Kind { subsection, set, end };

  Kind kind;
  std::string name; ///< of the subsection or the parameter
  std::size_t indentation;
  unsigned int line;
};

/// Subsection whose `end` is probably missing, and the line before which it belongs.
struct MissingEnd {
  SceneFile::Path path;
  unsigned int line;   ///< that opens it
  unsigned int before; ///< 0: at the end of the file
};

/// Finds the subsection that is most probably unclosed in a file with too few `end`s. It is the first one
/// that contains what belongs into a subsection above, or that an `end` indented as one above would close;
/// without such evidence, the innermost one that is open at the end. `outer`: path where the file is
/// included.
MissingEnd find_missing_end(const std::vector<Statement> &statements, const SceneFile::Path &outer);

} // namespace billet

#endif
