// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_CSV_COLUMNS_H
#define BILLET_MATERIAL_CSV_COLUMNS_H

#include "billet/registered_type.h"

#include <array>
#include <istream>
#include <string>
#include <vector>

namespace billet {

/// Reads columns of a table, which count from 1: numbers with commas, semicolons, tabs or blanks
/// between them. Skips comments after '#', empty lines, and lines before the first number. Throws
/// std::invalid_argument with the number of the faulty line.
std::vector<std::vector<double>> read_table(std::istream &text, const std::vector<unsigned int> &columns);
/// Reads two columns in the same way.
std::vector<std::array<double, 2>> read_columns(std::istream &text, std::array<unsigned int, 2> columns);

/// Reads columns of the file that `file_key` names; `columns_key` names the columns, at least two.
/// Refuses unusable files. `allowed`: what the columns must be, for messages.
std::vector<std::vector<double>> read_table(const TypeInput &input, const std::string &file_key,
                                            const std::string &columns_key, const std::string &allowed);
/// Reads two columns in the same way.
std::vector<std::array<double, 2>> read_columns(const TypeInput &input, const std::string &file_key,
                                                const std::string &columns_key);

/// Table of points in a scene: pairs of numbers of the parameter `key`, or two columns of the file
/// that "`key` file" names.
struct PointTable {
  std::string key;
  std::string names; ///< of both numbers, such as "strain : stress", for messages
  std::string rules; ///< description of `key`: what the points must be, and their units

  /// Returns the three parameters of the table.
  std::vector<TypeParameter> parameters() const;
  /// Reads the points; `used_key` gets the parameter that they come from. Refuses unusable tables.
  std::vector<std::array<double, 2>> read(const TypeInput &input, std::string &used_key) const;
};

} // namespace billet

#endif
