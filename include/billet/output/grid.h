// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_GRID_H
#define BILLET_OUTPUT_GRID_H

#include <cstdint>
#include <string>
#include <vector>

namespace billet {

/// Type of numbers in a file.
enum class FileNumber { float32, float64, int32, int64 };

/// Field of a grid: `n_components` numbers for each point, or for each cell. Six components are a
/// symmetric tensor in the order of VTK: xx, yy, zz, xy, yz, xz. Nine are a tensor, row by row.
struct GridField {
  std::string name;
  unsigned int n_components = 1;
  FileNumber type = FileNumber::float32;
  std::vector<double> values = {}; ///< of this rank; integers up to 2^53
};

/// Named block of a snapshot: hexahedra, or polygons of a surface. Each rank holds some of its
/// points and cells. The whole grid has those of the first rank, then those of the second, and so
/// on. All ranks have the same fields, even if they have no points.
struct Grid {
  std::string group, name;
  std::string material = {};                    ///< in words; empty for surfaces
  std::vector<double> points = {};              ///< three coordinates each
  std::vector<std::uint64_t> connectivity = {}; ///< numbers in the whole grid, in the order of VTK
  std::vector<unsigned int> sizes = {};         ///< number of points of each cell
  std::vector<GridField> point_fields = {}, cell_fields = {};

  std::size_t n_points() const { return points.size() / 3; }
  std::size_t n_cells() const { return sizes.size(); }
};

/// Returns VTK's type of a cell with this number of points: a hexahedron, a triangle, a
/// quadrilateral or a polygon.
std::uint8_t vtk_cell_type(unsigned int n_points);

/// Returns the text with the characters escaped that XML reserves.
std::string escape_xml(const std::string &text);

/// Joins scalars that are components of a tensor. Six names in a row with the endings _xx, _yy,
/// _zz, _xy, _xz and _yz become a symmetric tensor. Nine with _xx, _xy, ... _zz become a tensor.
/// All scalars have one value for each cell or point.
std::vector<GridField> join_components(std::vector<GridField> scalars);

} // namespace billet

#endif
