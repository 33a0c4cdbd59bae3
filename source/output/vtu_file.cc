// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/vtu_file.h"

#include <deal.II/base/utilities.h>

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

/// Returns the XML before each array, and the XML after the last one.
std::vector<std::string> make_tags(const std::vector<Section> &sections, const std::string &material,
                                   const std::uint64_t n_points, const std::uint64_t n_cells) {
  std::vector<std::string> tags;
  std::ostringstream tag;
  tag << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  if (!material.empty()) {
    tag << "<FieldData><DataArray type=\"String\" Name=\"material_name\" NumberOfTuples=\"1\" "
           "format=\"ascii\">";
    for (const char c : material)
      tag << static_cast<unsigned int>(static_cast<unsigned char>(c)) << " ";
    tag << "0</DataArray></FieldData>\n";
  }
  tag << "<Piece NumberOfPoints=\"" << n_points << "\" NumberOfCells=\"" << n_cells << "\">\n";
  for (const Section &section : sections) {
    tag << "<" << section.name << ">\n";
    for (const FileArray &array : section.arrays) {
      tag << "<DataArray type=\"" << array.type << "\" Name=\"" << escape_xml(array.name)
          << "\" NumberOfComponents=\"" << array.n_components << "\" format=\"binary\">\n";
      tags.push_back(tag.str());
      tag.str("\n</DataArray>\n");
      tag.seekp(0, std::ios::end);
    }
    tag << "</" << section.name << ">\n";
  }
  tag << "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  tags.push_back(tag.str());
  return tags;
}

/// Groups of three bytes, of which base64 makes four characters each; the last group of a text may be
/// shorter.
constexpr std::uint64_t group_bytes = 3, group_characters = 4;

constexpr std::uint64_t n_groups(const std::uint64_t n_bytes) {
  return (n_bytes + group_bytes - 1) / group_bytes;
}

/// Text of an array as base64, as far as it is this rank's: the groups that begin in its bytes.
struct ArrayText {
  std::uint64_t first_character, n_characters; // of this rank's text, and of the text of all ranks
  std::string characters;
};

/// Encodes arrays, each with its size in bytes before it. Groups go across the borders of ranks.
/// Collective.
std::vector<ArrayText> encode(const MPI_Comm communicator, const std::vector<std::string> &arrays) {
  int rank = 0, n_ranks = 1;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  std::vector<std::uint64_t> sizes;
  for (const std::string &array : arrays)
    sizes.push_back(array.size());
  const auto [before, all] = sum_ranks(communicator, sizes);

  // The first bytes of each rank, which may end the last group of the ranks before it.
  struct Start {
    unsigned char count, bytes[group_bytes - 1];
  };
  std::vector<Start> own(arrays.size()), starts(arrays.size() * static_cast<std::size_t>(n_ranks));
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    own[a].count = static_cast<unsigned char>(std::min(arrays[a].size(), std::size_t{group_bytes - 1}));
    std::copy_n(arrays[a].begin(), own[a].count, own[a].bytes);
  }
  const int n = static_cast<int>(arrays.size() * sizeof(Start));
  MPI_Allgather(own.data(), n, MPI_BYTE, starts.data(), n, MPI_BYTE, communicator);

  std::vector<ArrayText> texts;
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    const std::string size = to_bytes<std::uint64_t>(std::array<std::uint64_t, 1>{all[a]});
    const std::uint64_t total = size.size() + all[a];
    const std::uint64_t begin = rank == 0 ? 0 : size.size() + before[a];
    std::vector<unsigned char> bytes;
    bytes.reserve(size.size() + arrays[a].size() + group_bytes);
    if (rank == 0)
      bytes.assign(size.begin(), size.end());
    bytes.insert(bytes.end(), arrays[a].begin(), arrays[a].end());
    const std::uint64_t end = begin + bytes.size(), first = n_groups(begin), last = n_groups(end);
    if (first < last) {
      for (auto r = static_cast<std::size_t>(rank) + 1; r < static_cast<std::size_t>(n_ranks); ++r) {
        const Start &start = starts[r * arrays.size() + a];
        bytes.insert(bytes.end(), start.bytes, start.bytes + start.count);
      }
      bytes.resize(std::min(group_bytes * last, total) - begin);
      bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(group_bytes * first - begin));
    } else
      bytes.clear();
    texts.push_back({group_characters * first, group_characters * n_groups(total),
                     dealii::Utilities::encode_base64(bytes)});
  }
  return texts;
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

// Numbers stand inside their elements, since VTK 9.2 fails to read appended ones with the expat of Debian 12
// (2.5.0-1+deb12u5).
bool write_vtu(const MPI_Comm communicator, const std::string &file_name, const Grid &grid) {
  std::vector<Section> sections = make_sections(communicator, grid);
  const auto n_all = sum_ranks(communicator, {grid.n_points(), grid.n_cells()})[1];
  const std::vector<std::string> tags = make_tags(sections, grid.material, n_all[0], n_all[1]);
  std::vector<std::string> arrays;
  for (Section &section : sections)
    for (FileArray &array : section.arrays)
      arrays.push_back(std::move(array.bytes));
  const std::vector<ArrayText> texts = encode(communicator, arrays);

  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  const bool is_first = rank == 0;
  SharedFile file(communicator, file_name);
  std::uint64_t offset = 0;
  for (std::size_t a = 0; a < texts.size(); ++a) {
    const ArrayText &text = texts[a];
    if (is_first)
      file.write(offset, tags[a] + text.characters);
    else
      file.write(offset + tags[a].size() + text.first_character, text.characters);
    offset += tags[a].size() + text.n_characters;
  }
  file.write(offset, is_first ? tags.back() : "");
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
