// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SNAPSHOT_FILE_H
#define BILLET_TESTS_SNAPSHOT_FILE_H

#include <deal.II/base/hdf5.h>
#include <deal.II/lac/full_matrix.h>

#include <hdf5.h>

#include <set>
#include <string>
#include <vector>

namespace billet::testing {

/// Fields of the bodies in an HDF5 file of a snapshot. All values are those at the corners of the elements,
/// eight for each element, one body after the other.
class SnapshotFile {
public:
  SnapshotFile(const std::string &name, const unsigned int n_bodies)
      : of_nodes_(names_in(name, "block_0/point_data")), of_elements_(names_in(name, "block_0/cell_data")),
        file_(name, dealii::HDF5::File::FileAccessMode::open, MPI_COMM_WORLD), n_bodies_(n_bodies) {}

  /// Returns the component of a field of elements or nodes; of a tensor by its ending, such as stress_zz.
  std::vector<double> read(const std::string &name, const unsigned int component = 0) {
    if (of_elements_.count(name) > 0)
      return of_elements(name, component);
    if (of_nodes_.count(name) > 0)
      return of_nodes("point_data/" + name, component);
    const std::string axes = "xyz", ending = name.substr(name.size() - 2);
    return of_elements(name.substr(0, name.size() - 3),
                       static_cast<unsigned int>(3 * axes.find(ending[0]) + axes.find(ending[1])));
  }
  /// Returns a coordinate of the corners.
  std::vector<double> positions(const unsigned int component) { return of_nodes("points", component); }
  /// Returns the number of nodes in the file.
  std::size_t n_nodes() {
    std::size_t n = 0;
    for (unsigned int body = 0; body < n_bodies_; ++body)
      n += matrix(body, "points").m();
    return n;
  }

private:
  dealii::FullMatrix<double> matrix(const unsigned int body, const std::string &path) {
    return file_.open_dataset("block_" + std::to_string(body) + "/" + path)
        .read<dealii::FullMatrix<double>>();
  }
  std::vector<double> of_elements(const std::string &name, const unsigned int component) {
    std::vector<double> values;
    for (unsigned int body = 0; body < n_bodies_; ++body) {
      const auto field = matrix(body, "cell_data/" + name);
      for (unsigned int e = 0; e < field.m(); ++e)
        values.insert(values.end(), 8, field(e, component));
    }
    return values;
  }
  std::vector<double> of_nodes(const std::string &path, const unsigned int component) {
    std::vector<double> values;
    for (unsigned int body = 0; body < n_bodies_; ++body) {
      const auto field = matrix(body, path), corners = matrix(body, "connectivity");
      for (unsigned int e = 0; e < corners.m(); ++e)
        for (unsigned int k = 0; k < 8; ++k)
          values.push_back(field(static_cast<unsigned int>(corners(e, k)), component));
    }
    return values;
  }
  /// Returns the names in a group.
  static std::set<std::string> names_in(const std::string &file_name, const std::string &group) {
    std::set<std::string> names;
    const hid_t file = H5Fopen(file_name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t place = H5Gopen2(file, group.c_str(), H5P_DEFAULT);
    const auto add = [](hid_t, const char *name, const H5L_info_t *, void *data) -> herr_t {
      static_cast<std::set<std::string> *>(data)->insert(name);
      return 0;
    };
    H5Literate(place, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names);
    H5Gclose(place);
    H5Fclose(file);
    return names;
  }

  std::set<std::string> of_nodes_, of_elements_;
  dealii::HDF5::File file_;
  unsigned int n_bodies_;
};

} // namespace billet::testing

#endif
