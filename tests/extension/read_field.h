// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_EXTENSION_READ_FIELD_H
#define BILLET_TESTS_EXTENSION_READ_FIELD_H

#include "billet/output/field_writer.h"

#include "../snapshot_file.h"
#include "../testing.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace billet::testing {

/// Writes the fields of a scene with format HDF5 into a new folder. Returns the file's name.
inline std::string write_fields(const Scene &scene, const Solution &solution) {
  std::filesystem::create_directory("fields");
  FieldWriter(scene, MPI_COMM_WORLD, "fields").write(solution);
  return "fields/fields_00000.h5";
}

/// The component of a field at each vertex of each element.
inline std::vector<double> read_field(const std::string &file_name, const std::string &field,
                                      const unsigned int component = 0, const unsigned int n_bodies = 1) {
  return SnapshotFile(file_name, n_bodies).read(field, component);
}

inline double max_difference(const std::vector<double> &values, const std::vector<double> &others) {
  if (values.size() != others.size())
    return std::nan("");
  WorstError error;
  for (std::size_t i = 0; i < values.size(); ++i)
    error.add(std::abs(values[i] - others[i]));
  return error.value();
}
inline double max_difference(const std::vector<double> &values, const double other) {
  return max_difference(values, std::vector<double>(values.size(), other));
}

} // namespace billet::testing

#endif
