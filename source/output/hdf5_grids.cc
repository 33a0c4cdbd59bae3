// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/hdf5_grids.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

namespace billet {

namespace {

/// Owner of an HDF5 identifier; closes it.
class GridHandle {
public:
  using Close = herr_t (*)(hid_t);
  GridHandle(const hid_t id, const Close close) : id_(id), close_(close) {}
  ~GridHandle() { close(); }
  GridHandle(const GridHandle &) = delete;
  GridHandle &operator=(const GridHandle &) = delete;

  hid_t id() const { return id_; }
  bool is_open() const { return id_ >= 0; }
  /// Returns whether that succeeded.
  bool close() {
    const bool is_closed = id_ < 0 || close_(id_) >= 0;
    id_ = H5I_INVALID_HID;
    return is_closed;
  }

private:
  hid_t id_;
  Close close_;
};

hid_t file_type(const FileNumber type) {
  switch (type) {
  case FileNumber::float64:
    return H5T_IEEE_F64LE;
  case FileNumber::int32:
    return H5T_STD_I32LE;
  case FileNumber::int64:
    return H5T_STD_I64LE;
  case FileNumber::float32:
    break;
  }
  return H5T_IEEE_F32LE;
}

std::string number_attributes(const FileNumber type) {
  const bool is_float = type == FileNumber::float32 || type == FileNumber::float64;
  const bool is_long = type == FileNumber::float64 || type == FileNumber::int64;
  return std::string(R"( NumberType=")") + (is_float ? "Float" : "Int") + R"(" Precision=")" +
         (is_long ? "8" : "4") + R"(" Format="HDF")";
}

/// Returns symmetric tensors with all nine components: the readers of XDMF do not agree on the
/// order of six.
GridField to_full_tensor(const GridField &field) {
  constexpr std::size_t n_symmetric = 6;
  constexpr std::array<std::size_t, 9> places{0, 3, 5, 3, 1, 4, 5, 4, 2}; // of xx, xy, xz, yx, ...
  if (field.n_components != n_symmetric)
    return field;
  GridField full{field.name, static_cast<unsigned int>(places.size()), field.type};
  full.values.reserve(field.values.size() / n_symmetric * places.size());
  for (std::size_t i = 0; i < field.values.size(); i += n_symmetric)
    for (const std::size_t place : places)
      full.values.push_back(field.values[i + place]);
  return full;
}

/// File into which all ranks write.
class Hdf5File {
public:
  Hdf5File(const MPI_Comm communicator, const std::string &folder, std::string name)
      : communicator_(communicator), name_(std::move(name)), access_(H5Pcreate(H5P_FILE_ACCESS), H5Pclose),
        transfer_(H5Pcreate(H5P_DATASET_XFER), H5Pclose),
        file_((H5Pset_fapl_mpio(access_.id(), communicator, MPI_INFO_NULL),
               H5Fcreate((folder + "/" + name_).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access_.id())),
              H5Fclose),
        is_good_(file_.is_open()) {
    H5Pset_dxpl_mpio(transfer_.id(), H5FD_MPIO_COLLECTIVE);
  }

  void add_group(const std::string &group) {
    if (!is_good_)
      return;
    const GridHandle handle(H5Gcreate2(file_.id(), group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                            H5Gclose);
    is_good_ = handle.is_open();
  }

  /// Writes the rows of all ranks. Returns XDMF's reference to them. Collective.
  std::string write(const std::string &path, const GridField &field) {
    const std::uint64_t n_columns = field.n_components, n = field.values.size() / n_columns;
    std::uint64_t first = 0, all = 0;
    int rank = 0;
    MPI_Comm_rank(communicator_, &rank);
    MPI_Exscan(&n, &first, 1, MPI_UINT64_T, MPI_SUM, communicator_);
    MPI_Allreduce(&n, &all, 1, MPI_UINT64_T, MPI_SUM, communicator_);
    if (rank == 0)
      first = 0; // MPI leaves it undefined
    write_rows(path, field, {first, 0}, {n, n_columns}, {all, n_columns});
    std::ostringstream text;
    text << R"(<DataItem Dimensions=")" << all << " " << n_columns << R"(")" << number_attributes(field.type)
         << ">" << name_ << ":" << path << "</DataItem>";
    return text.str();
  }

  /// Closes the file. Returns whether everything is in it, the same on all ranks. Collective.
  bool close() {
    is_good_ = file_.close() && is_good_;
    int good = is_good_ ? 1 : 0, all_good = 0;
    MPI_Allreduce(&good, &all_good, 1, MPI_INT, MPI_MIN, communicator_);
    return all_good == 1;
  }

private:
  using Extent = std::array<hsize_t, 2>;

  void write_rows(const std::string &path, const GridField &field, const Extent start, const Extent count,
                  const Extent extent) {
    if (!is_good_)
      return;
    const GridHandle space(H5Screate_simple(2, extent.data(), nullptr), H5Sclose);
    const GridHandle memory(H5Screate_simple(2, count.data(), nullptr), H5Sclose);
    const GridHandle data(H5Dcreate2(file_.id(), path.c_str(), file_type(field.type), space.id(), H5P_DEFAULT,
                                     H5P_DEFAULT, H5P_DEFAULT),
                          H5Dclose);
    if (count[0] == 0) {
      H5Sselect_none(space.id());
      H5Sselect_none(memory.id());
    } else
      H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    is_good_ = data.is_open() && H5Dwrite(data.id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(),
                                          transfer_.id(), field.values.data()) >= 0;
  }

  MPI_Comm communicator_;
  std::string name_;
  GridHandle access_, transfer_, file_;
  bool is_good_;
};

/// Topology of a grid in XDMF's words: the name of its type, and its numbers.
struct Topology {
  std::string type;
  GridField numbers;
};

/// Collective.
Topology make_topology(const MPI_Comm communicator, const Grid &grid) {
  int min = std::numeric_limits<int>::max(), max = 0;
  for (const unsigned int size : grid.sizes) {
    min = std::min(min, static_cast<int>(size));
    max = std::max(max, static_cast<int>(size));
  }
  MPI_Allreduce(MPI_IN_PLACE, &min, 1, MPI_INT, MPI_MIN, communicator);
  MPI_Allreduce(MPI_IN_PLACE, &max, 1, MPI_INT, MPI_MAX, communicator);
  Topology topology{"Mixed", {"", 1, FileNumber::int64}};
  const bool is_uniform = min == max && (max == 3 || max == 4 || max == 8);
  if (is_uniform) {
    topology.type = max == 3 ? "Triangle" : max == 4 ? "Quadrilateral" : "Hexahedron";
    topology.numbers.n_components = static_cast<unsigned int>(max);
  }
  std::size_t next = 0;
  for (const unsigned int size : grid.sizes) {
    if (!is_uniform) { // XDMF numbers the types of cells; polygons have their size behind
      constexpr double polygon = 3., triangle = 4., quadrilateral = 5.;
      topology.numbers.values.push_back(size == 3 ? triangle : size == 4 ? quadrilateral : polygon);
      if (size > 4)
        topology.numbers.values.push_back(size);
    }
    for (unsigned int i = 0; i < size; ++i)
      topology.numbers.values.push_back(static_cast<double>(grid.connectivity[next++]));
  }
  return topology;
}

/// Writes a grid into a group. Returns its description. Collective.
std::string write_grid(const MPI_Comm communicator, Hdf5File &file, const std::string &group,
                       const Grid &grid) {
  file.add_group(group);
  std::uint64_t n_cells = grid.n_cells();
  MPI_Allreduce(MPI_IN_PLACE, &n_cells, 1, MPI_UINT64_T, MPI_SUM, communicator);
  std::ostringstream text;
  text << R"(<Grid Name=")" << escape_xml(grid.name) << R"(" GridType="Uniform">)"
       << "\n";
  if (!grid.material.empty())
    text << R"(<Information Name="material_name" Value=")" << escape_xml(grid.material) << "\"/>\n";
  const Topology topology = make_topology(communicator, grid);
  text << R"(<Topology TopologyType=")" << topology.type << R"(" NumberOfElements=")" << n_cells << R"(">)"
       << file.write(group + "/connectivity", topology.numbers) << "</Topology>\n"
       << R"(<Geometry GeometryType="XYZ">)"
       << file.write(group + "/points", {"", 3, FileNumber::float64, grid.points}) << "</Geometry>\n";
  const auto add = [&](const std::string &centre, const std::string &folder,
                       const std::vector<GridField> &fields) {
    file.add_group(group + folder);
    for (const GridField &field : fields) {
      const unsigned int n = field.n_components;
      text << R"(<Attribute Name=")" << escape_xml(field.name) << R"(" AttributeType=")"
           << (n == 3  ? "Vector"
               : n > 3 ? "Tensor"
                       : "Scalar")
           << R"(" Center=")" << centre << R"(">)"
           << file.write(group + folder + "/" + field.name, to_full_tensor(field)) << "</Attribute>\n";
    }
  };
  add("Node", "/point_data", grid.point_fields);
  add("Cell", "/cell_data", grid.cell_fields);
  text << "</Grid>\n";
  return n_cells > 0 ? text.str() : "";
}

} // namespace

std::string write_hdf5(const MPI_Comm communicator, const std::string &folder, const std::string &file_name,
                       const double time, const std::vector<std::string> &groups,
                       const std::vector<Grid> &grids) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // the caller names the problem
  Hdf5File file(communicator, folder, file_name);
  std::ostringstream text;
  text.precision(12);
  text << R"(<Grid Name="scene" GridType="Collection" CollectionType="Spatial">)"
       << "\n"
       << R"(<Time Value=")" << time << "\"/>\n";
  std::vector<std::string> parts(groups.size());
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const std::string part = write_grid(communicator, file, "/block_" + std::to_string(i), grids[i]);
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (groups[g] == grids[i].group)
        parts[g] += part;
  }
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (!parts[g].empty())
      text << R"(<Grid Name=")" << groups[g] << R"(" GridType="Collection" CollectionType="Spatial">)"
           << "\n"
           << parts[g] << "</Grid>\n";
  text << "</Grid>\n";
  return file.close() ? text.str() : "";
}

std::string xdmf_index(const std::string &snapshots) {
  return "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
         "<Grid Name=\"scene\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" +
         snapshots + "</Grid>\n</Domain>\n</Xdmf>\n";
}

} // namespace billet
