// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_UNMATCHED_ENDS_H
#define BILLET_PARAMETERS_UNMATCHED_ENDS_H

#include "billet/parameters/scene_file.h"

#include <cstddef>
#include <string>
#include <vector>

namespace billet {

/// Most subsections within each other. Paths of a hostile file with more would take all memory.
constexpr std::size_t max_nesting = 50;

/// Statement that opens or closes a subsection, or sets a parameter.
struct Statement {
  enum class Kind { subsection, set, end };

  Kind kind;
  std::string name; ///< of the subsection or the parameter
  std::size_t indentation;
  unsigned int line;
};

/// Repair of a file in which not each `end` has its subsection, or not each subsection its `end`.
struct EndRepair {
  enum class Kind {
    insert, ///< an `end` before the line
    ignore  ///< the `end` in the line
  };

  Kind kind;
  unsigned int line;
};

/// Finds where `end`s are probably missing, and which are probably one too many, in the order in
/// which they are found. An `end` is missing in the first subsection that contains what belongs
/// into one above, or that an `end` indented as one above would close. An `end` is one too many if
/// what follows belongs into the subsection that it closes, or if it is indented more than that.
/// Without such evidence there is no repair: subsections end with the file, and an `end` at the top
/// level closes nothing. `outer`: path where the file is included.
std::vector<EndRepair> find_end_repairs(std::vector<Statement> statements, const SceneFile::Path &outer);

} // namespace billet

#endif
