// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mesh/mesh_file.h"

#include "billet/mesh/mesh_cursor.h"
#include "billet/mesh/plane_mesh.h"
#include "billet/printable.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace billet {

namespace {

std::string read_bytes(const std::string &file_name) {
  // A device or a pipe may never end.
  if (!std::filesystem::is_regular_file(file_name))
    throw std::invalid_argument("'" + file_name + "' is no file that can be read");
  std::ifstream stream(file_name, std::ios::binary);
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  if (!stream)
    throw std::invalid_argument("'" + file_name + "' cannot be read");
  return buffer.str();
}

} // namespace

std::vector<MeshFormat> &mesh_formats() {
  static std::vector<MeshFormat> formats{gmsh_format(), vtk_format(), abaqus_format(), ucd_format()};
  return formats;
}

namespace {

/// Whether this is a keyword file of LS-DYNA: its first line that is no comment is *KEYWORD.
bool is_ls_dyna(const std::string &bytes) {
  MeshCursor cursor(bytes);
  while (cursor.next_word().substr(0, 1) == "$")
    cursor.line();
  return lower_case(cursor.next_word()) == "*keyword";
}

MeshFile parse(const std::string &bytes, const FileAccess &access) {
  const std::string byte_order_mark = "\xEF\xBB\xBF";
  if (bytes.compare(0, byte_order_mark.size(), byte_order_mark) == 0)
    return parse(bytes.substr(byte_order_mark.size()), access);
  for (const MeshFormat &format : mesh_formats())
    if (format.recognises(bytes))
      return format.read(bytes, access);
  const std::string beginning = bytes.substr(0, 1000);
  if (beginning.find("<VTKFile") != std::string::npos)
    throw std::invalid_argument(
        "it is XML of VTK, which is not read; convert it to Gmsh's format: 'meshio convert "
        "part.vtu part.msh' (Debian package python3-meshio)");
  std::string known;
  for (const MeshFormat &format : mesh_formats())
    known += (known.empty() ? "" : ", ") + format.meaning;
  throw std::invalid_argument((is_ls_dyna(bytes) ? "it is a keyword file of LS-DYNA, so that " : "") +
                              std::string("its content is in none of these formats: ") + known +
                              "; Gmsh converts many others: 'gmsh -save -format msh41 -o part.msh part.unv'");
}

/// Length of the longest message [characters].
constexpr std::size_t max_message = 1000;

} // namespace

MeshFile parse_mesh(const std::string &bytes, const FileAccess &access) {
  try {
    MeshFile mesh = parse(bytes, access);
    if (mesh.hexahedra.empty())
      throw std::invalid_argument(
          "it has no hexahedra but " + std::to_string(mesh.plane.quadrilaterals.size()) +
          " quadrilaterals: a surface, which has no volume (in Gmsh: 'Mesh 3', with the volume in a "
          "physical group if there are any). 'Section = plane strain' or 'axisymmetric' takes a "
          "two-dimensional mesh");
    return mesh;
  } catch (const std::invalid_argument &error) {
    throw std::invalid_argument(printable(error.what(), max_message));
  }
}

MeshFile parse_plane_mesh(const std::string &bytes, const FileAccess &access) {
  try {
    MeshFile mesh = parse(bytes, access);
    extrude_plane(mesh);
    return mesh;
  } catch (const std::invalid_argument &error) {
    throw std::invalid_argument(printable(error.what(), max_message));
  }
}

namespace {

/// Reads a file by one of these functions.
MeshFile read_by(MeshFile (*const parse_bytes)(const std::string &bytes, const FileAccess &access),
                 const std::string &file_name) {
  const std::filesystem::path folder = std::filesystem::path(file_name).parent_path();
  return parse_bytes(read_bytes(file_name),
                     [&folder](const std::string &name) { return read_bytes((folder / name).string()); });
}

} // namespace

MeshFile read_mesh_file(const std::string &file_name) { return read_by(&parse_mesh, file_name); }

MeshFile read_plane_mesh_file(const std::string &file_name) { return read_by(&parse_plane_mesh, file_name); }

} // namespace billet
