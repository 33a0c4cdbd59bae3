// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/vtu_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

namespace billet {

namespace {

/// Array of a file: its description, and the bytes of this rank.
struct FileArray {
  const char *type;
  std::string name;
  unsigned int n_components;
  std::string bytes;
};

template <class Number, class Values> std::string to_bytes(const Values &values) {
  std::string bytes;
  bytes.reserve(values.size() * sizeof(Number));
  for (const auto value : values) {
    const auto number = static_cast<Number>(value);
    bytes.append(reinterpret_cast<const char *>(&number), sizeof(Number)); // NOLINT: these are the bytes
  }
  return bytes;
}

/// Returns floats. Larger values become the largest one, since the conversion would trap.
std::string to_floats(const std::vector<double> &values) {
  static constexpr double max = std::numeric_limits<float>::max();
  std::vector<double> bounded(values.size());
  std::transform(values.begin(), values.end(), bounded.begin(),
                 [](const double value) { return std::min(max, std::max(-max, value)); });
  return to_bytes<float>(bounded);
}

FileArray make_array(const GridField &field) {
  switch (field.type) {
  case FileNumber::float64:
    return {"Float64", field.name, field.n_components, to_bytes<double>(field.values)};
  case FileNumber::int32:
    return {"Int32", field.name, field.n_components, to_bytes<std::int32_t>(field.values)};
  case FileNumber::int64:
    return {"Int64", field.name, field.n_components, to_bytes<std::int64_t>(field.values)};
  case FileNumber::float32:
    break;
  }
  return {"Float32", field.name, field.n_components, to_floats(field.values)};
}

/// Part of a file: an XML element that has arrays.
struct Section {
  std::string name;
  std::vector<FileArray> arrays;
};

/// Returns the sum over the ranks before this one, and over all. Collective.
std::array<std::vector<std::uint64_t>, 2> sum_ranks(const MPI_Comm communicator,
                                                    const std::vector<std::uint64_t> &values) {
  std::vector<std::uint64_t> before(values.size(), 0), all(values.size(), 0);
  const int n = static_cast<int>(values.size());
  MPI_Exscan(values.data(), before.data(), n, MPI_UINT64_T, MPI_SUM, communicator);
  MPI_Allreduce(values.data(), all.data(), n, MPI_UINT64_T, MPI_SUM, communicator);
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  if (rank == 0)
    std::fill(before.begin(), before.end(), 0); // MPI leaves it undefined
  return {before, all};
}

std::vector<Section> make_sections(const MPI_Comm communicator, const Grid &grid) {
  const std::uint64_t n_corners = grid.connectivity.size();
  std::uint64_t end = sum_ranks(communicator, {n_corners})[0][0];
  std::vector<std::uint64_t> ends;
  std::string types;
  for (const unsigned int size : grid.sizes) {
    ends.push_back(end += size);
    types += static_cast<char>(vtk_cell_type(size));
  }
  std::vector<Section> sections{{"Points", {{"Float64", "Points", 3, to_bytes<double>(grid.points)}}},
                                {"Cells",
                                 {{"Int64", "connectivity", 1, to_bytes<std::int64_t>(grid.connectivity)},
                                  {"Int64", "offsets", 1, to_bytes<std::int64_t>(ends)},
                                  {"UInt8", "types", 1, types}}},
                                {"PointData", {}},
                                {"CellData", {}}};
  for (const GridField &field : grid.point_fields)
    sections[2].arrays.push_back(make_array(field));
  for (const GridField &field : grid.cell_fields)
    sections[3].arrays.push_back(make_array(field));
  return sections;
}

/// Returns the XML before the numbers. `sizes`: bytes of all ranks, of each array.
std::string make_head(const std::vector<Section> &sections, const std::vector<std::uint64_t> &sizes,
                      const std::string &material, const std::uint64_t n_points,
                      const std::uint64_t n_cells) {
  std::ostringstream head;
  head << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
          "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  if (!material.empty()) {
    head << "<FieldData><DataArray type=\"String\" Name=\"material_name\" NumberOfTuples=\"1\" "
            "format=\"ascii\">";
    for (const char c : material)
      head << static_cast<unsigned int>(static_cast<unsigned char>(c)) << " ";
    head << "0</DataArray></FieldData>\n";
  }
  head << "<Piece NumberOfPoints=\"" << n_points << "\" NumberOfCells=\"" << n_cells << "\">\n";
  std::uint64_t offset = 0;
  std::size_t next = 0;
  for (const Section &section : sections) {
    head << "<" << section.name << ">\n";
    for (const FileArray &array : section.arrays) {
      head << "<DataArray type=\"" << array.type << "\" Name=\"" << escape_xml(array.name)
           << "\" NumberOfComponents=\"" << array.n_components << "\" format=\"appended\" offset=\"" << offset
           << "\"/>\n";
      offset += sizeof(std::uint64_t) + sizes[next++];
    }
    head << "</" << section.name << ">\n";
  }
  head << "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  return head.str();
}

/// File into which all ranks write.
class SharedFile {
public:
  SharedFile(const MPI_Comm communicator, const std::string &name) : communicator_(communicator) {
    is_good_ = MPI_File_open(communicator, name.c_str(), MPI_MODE_CREATE | MPI_MODE_WRONLY, MPI_INFO_NULL,
                             &file_) == MPI_SUCCESS;
    is_open_ = is_good_;
    if (is_open_)
      is_good_ = MPI_File_set_size(file_, 0) == MPI_SUCCESS;
  }
  SharedFile(const SharedFile &) = delete;
  SharedFile &operator=(const SharedFile &) = delete;
  ~SharedFile() {
    if (is_open_)
      MPI_File_close(&file_);
  }

  /// Writes the bytes of this rank. Collective.
  void write(const std::uint64_t offset, const std::string &bytes) {
    constexpr std::uint64_t chunk = std::uint64_t{1} << 30U; // counts of MPI are int
    std::uint64_t n = bytes.size(), max = 0;
    MPI_Allreduce(&n, &max, 1, MPI_UINT64_T, MPI_MAX, communicator_);
    for (std::uint64_t start = 0; is_open_ && start < max; start += chunk) {
      const std::uint64_t from = std::min(start, n), count = std::min(chunk, n - from);
      MPI_Status status;
      const int code = MPI_File_write_at_all(file_, static_cast<MPI_Offset>(offset + from),
                                             bytes.data() + from, static_cast<int>(count), MPI_BYTE, &status);
      int written = 0;
      is_good_ = is_good_ && code == MPI_SUCCESS &&
                 (count == 0 || (MPI_Get_count(&status, MPI_BYTE, &written) == MPI_SUCCESS &&
                                 static_cast<std::uint64_t>(written) == count));
    }
  }

  /// Closes the file. Returns whether all that was written on all ranks is in it. Collective.
  bool close() {
    if (is_open_)
      is_good_ = MPI_File_close(&file_) == MPI_SUCCESS && is_good_;
    is_open_ = false;
    int good = is_good_ ? 1 : 0, all_good = 0;
    MPI_Allreduce(&good, &all_good, 1, MPI_INT, MPI_MIN, communicator_);
    return all_good == 1;
  }

private:
  MPI_Comm communicator_;
  MPI_File file_ = MPI_FILE_NULL;
  bool is_open_ = false, is_good_ = false;
};

} // namespace

bool write_vtu(const MPI_Comm communicator, const std::string &file_name, const Grid &grid) {
  const std::vector<Section> sections = make_sections(communicator, grid);
  std::vector<std::uint64_t> sizes{grid.n_points(), grid.n_cells()};
  for (const Section &section : sections)
    for (const FileArray &array : section.arrays)
      sizes.push_back(array.bytes.size());
  auto [before, all] = sum_ranks(communicator, sizes);
  const std::uint64_t n_points = all[0], n_cells = all[1];
  all.erase(all.begin(), all.begin() + 2);
  before.erase(before.begin(), before.begin() + 2);

  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  const bool is_first = rank == 0;
  const std::string head = make_head(sections, all, grid.material, n_points, n_cells);
  SharedFile file(communicator, file_name);
  file.write(0, is_first ? head : "");
  std::uint64_t offset = head.size();
  std::size_t next = 0;
  for (const Section &section : sections)
    for (const FileArray &array : section.arrays) {
      // The first rank's bytes begin with the size of the whole array.
      const std::uint64_t size = all[next];
      if (is_first)
        file.write(offset, to_bytes<std::uint64_t>(std::array<std::uint64_t, 1>{size}) + array.bytes);
      else
        file.write(offset + sizeof(size) + before[next], array.bytes);
      offset += sizeof(size) + size;
      ++next;
    }
  file.write(offset, is_first ? "\n</AppendedData>\n</VTKFile>\n" : "");
  return file.close();
}

std::string multiblock_index(const std::vector<std::string> &groups, const std::vector<GridFile> &files) {
  std::ostringstream text;
  text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" "
          "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<vtkMultiBlockDataSet>\n";
  for (std::size_t g = 0; g < groups.size(); ++g) {
    text << "<Block index=\"" << g << "\" name=\"" << escape_xml(groups[g]) << "\">\n";
    std::size_t index = 0;
    for (const GridFile &file : files)
      if (file.group == groups[g])
        text << "<DataSet index=\"" << index++ << "\" name=\"" << escape_xml(file.name) << "\" file=\""
             << escape_xml(file.file) << "\"/>\n";
    text << "</Block>\n";
  }
  text << "</vtkMultiBlockDataSet>\n</VTKFile>\n";
  return text.str();
}

} // namespace billet
