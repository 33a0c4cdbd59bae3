// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CAD_FILE_H
#define BILLET_GEOMETRY_CAD_FILE_H

#include <cstddef>
#include <string>

namespace billet {

/// Findings from the text of a CAD file, without its geometry.
struct CadFileReport {
  std::string fault;       ///< what shows that it is cut short or damaged; empty if nothing does
  std::size_t n_faces = 0; ///< faces bounded by curves that it defines
};

/// Checks a STEP file (ISO 10303-21): its end, and that each entity that is named is defined once.
CadFileReport check_step_file(const std::string &text);

/// Checks an IGES file of fixed line length: the numbers of lines of its sections, which its last line tells.
CadFileReport check_iges_file(const std::string &text);

} // namespace billet

#endif
