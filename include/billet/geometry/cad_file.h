// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CAD_FILE_H
#define BILLET_GEOMETRY_CAD_FILE_H

#include <deal.II/base/tensor.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace billet {

/// Findings from the text of a CAD file, without its geometry.
struct CadFileReport {
  std::string fault;       ///< what shows that it is cut short or damaged; empty if nothing does
  std::size_t n_faces = 0; ///< faces bounded by curves that it defines
};

/// Checks a STEP file (ISO 10303-21): its end, that each entity that is named is defined once, and
/// what find_faulty_entity() finds.
CadFileReport check_step_file(const std::string &text);

/// Checks an IGES file of fixed line length: the numbers of lines of its sections, which its last
/// line tells.
CadFileReport check_iges_file(const std::string &text);

/// Face of a CAD file.
struct CadFace {
  std::string kind;                        ///< "plane", "cylinder of radius 5"
  std::array<dealii::Tensor<1, 3>, 2> box; ///< least and largest coordinates [mm]
  std::vector<std::size_t> neighbours;     ///< numbers of the faces beside it, in ascending order
};

/// Returns the faces of a file, the first of which has number 1 in scenes. Throws InputError for a
/// file that a tool could not have, or without OpenCASCADE.
std::vector<CadFace> list_cad_faces(const std::string &file_name);

} // namespace billet

#endif
