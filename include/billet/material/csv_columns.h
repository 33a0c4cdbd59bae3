// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_CSV_COLUMNS_H
#define BILLET_MATERIAL_CSV_COLUMNS_H

#include "billet/registered_type.h"

#include <array>
#include <istream>
#include <string>
#include <vector>

namespace billet {

/// Reads two columns of a table, which count from 1: numbers with commas, semicolons, tabs or blanks between
/// them. Skips comments after '#', empty lines, and lines before the first number. Throws
/// std::invalid_argument with the number of the faulty line.
std::vector<std::array<double, 2>> read_columns(std::istream &text, std::array<unsigned int, 2> columns);

/// Reads two columns of the file that `file_key` names; `columns_key` names the columns. Refuses unusable
/// files.
std::vector<std::array<double, 2>> read_columns(const TypeInput &input, const std::string &file_key,
                                                const std::string &columns_key);

/// Reads the pairs of numbers of a parameter: 'FIRST : SECOND' between commas. `names`: what they are, such
/// as "strain : stress", for messages.
std::vector<std::array<double, 2>> read_pairs(const TypeInput &input, const std::string &key,
                                              const std::string &names);

} // namespace billet

#endif
