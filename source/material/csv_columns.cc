// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/csv_columns.h"

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace billet {

namespace {

/// Returns what separates the cells of a line: blanks only if nothing else does.
char separator_of(const std::string &line) {
  const auto has = [&line](const char c) { return line.find(c) != std::string::npos; };
  return has(';') ? ';' : has(',') ? ',' : has('\t') ? '\t' : ' ';
}

/// Returns the cells of a line without comments.
std::vector<std::string> split(const std::string &line, const char separator) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, separator);) {
    const auto begin = cell.find_first_not_of(" \t\r\"");
    const auto end = cell.find_last_not_of(" \t\r\"");
    if (begin != std::string::npos)
      cells.push_back(cell.substr(begin, end - begin + 1));
    else if (separator != ' ')
      cells.emplace_back();
  }
  if (cells.size() == 1 && cells.front().empty())
    cells.clear();
  return cells;
}

/// Whether a cell is a number with a decimal comma.
bool has_decimal_comma(std::string cell) {
  const std::size_t comma = cell.find(',');
  if (comma == std::string::npos || cell.find_first_of("0123456789", comma) != comma + 1)
    return false;
  cell[comma] = '.';
  try {
    parse_number(cell);
    return true;
  } catch (const std::invalid_argument &) {
    return false;
  }
}

/// Returns the first number with a decimal comma between semicolons, or else between tabs or
/// blanks; empty if there is none.
std::string find_decimal_comma(std::string line) {
  const bool has_semicolons = line.find(';') != std::string::npos;
  if (!has_semicolons)
    std::replace(line.begin(), line.end(), '\t', ' ');
  const std::vector<std::string> cells = split(line, has_semicolons ? ';' : ' ');
  if (cells.size() < 2) // commas separate cells
    return "";
  const auto found = std::find_if(cells.begin(), cells.end(), has_decimal_comma);
  return found == cells.end() ? "" : *found;
}

} // namespace

std::vector<std::vector<double>> read_table(std::istream &text, const std::vector<unsigned int> &columns) {
  std::vector<std::vector<double>> rows;
  std::string line;
  for (unsigned int number = 1; std::getline(text, line); ++number) {
    if (number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) // a byte-order mark
      line.erase(0, 3);
    line = line.substr(0, line.find('#'));
    const std::vector<std::string> cells = split(line, separator_of(line));
    if (cells.empty())
      continue;
    std::vector<double> row;
    for (const unsigned int column : columns)
      try {
        if (column > cells.size())
          throw std::invalid_argument("has no column " + std::to_string(column));
        row.push_back(parse_number(cells[column - 1]));
      } catch (const std::invalid_argument &) {
        const std::string comma = find_decimal_comma(line);
        if (rows.empty() && comma.empty()) // a head
          break;
        throw std::invalid_argument(
            "line " + std::to_string(number) + " has no number in column " + std::to_string(column) +
            (comma.empty() ? "" : ", but '" + comma + "': write decimals with a point, not with a comma"));
      }
    if (row.size() == columns.size())
      rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<std::array<double, 2>> read_columns(std::istream &text,
                                                const std::array<unsigned int, 2> columns) {
  std::vector<std::array<double, 2>> rows;
  for (const auto &row : read_table(text, {columns[0], columns[1]}))
    rows.push_back({row[0], row[1]});
  return rows;
}

std::vector<std::vector<double>> read_table(const TypeInput &input, const std::string &file_key,
                                            const std::string &columns_key, const std::string &allowed) {
  const auto numbers = input.numbers(columns_key);
  if (numbers.size() < 2 || std::any_of(numbers.begin(), numbers.end(), [](const double number) {
        return !(number >= 1. && number <= 1000. && number == std::floor(number));
      }))
    input.reject(columns_key, allowed);
  std::ifstream stream(input.file(file_key));
  std::vector<std::vector<double>> rows;
  try {
    rows = read_table(stream, std::vector<unsigned int>(numbers.begin(), numbers.end()));
  } catch (const std::invalid_argument &error) {
    input.reject(file_key, std::string("a table of numbers; ") + error.what());
  }
  if (rows.empty())
    input.reject(file_key, "a table with numbers in the columns " + input.text(columns_key));
  return rows;
}

std::vector<std::array<double, 2>> read_columns(const TypeInput &input, const std::string &file_key,
                                                const std::string &columns_key) {
  const std::string allowed = "two whole numbers from 1 to 1000, separated by a comma";
  if (input.numbers(columns_key).size() != 2)
    input.reject(columns_key, allowed);
  std::vector<std::array<double, 2>> rows;
  for (const auto &row : read_table(input, file_key, columns_key, allowed))
    rows.push_back({row[0], row[1]});
  return rows;
}

namespace {

/// Reads the pairs of numbers of a parameter: 'FIRST : SECOND' between commas.
std::vector<std::array<double, 2>> read_pairs(const TypeInput &input, const std::string &key,
                                              const std::string &names) {
  std::vector<std::array<double, 2>> pairs;
  for (const std::string &part : input.parts(key, ',')) {
    const auto pair = dealii::Utilities::split_string_list(part, ':');
    try {
      if (pair.size() != 2)
        throw std::invalid_argument("pair");
      pairs.push_back({parse_number(pair[0]), parse_number(pair[1])});
    } catch (const std::invalid_argument &) {
      input.reject(key, "'" + names + "' pairs, separated by commas");
    }
  }
  return pairs;
}

} // namespace

std::vector<TypeParameter> PointTable::parameters() const {
  using Kind = TypeParameter::Kind;
  return {{key, "", Kind::text, "Points '" + names + "', separated by commas. " + rules},
          {key + " file", "", Kind::text,
           "CSV file of these points, relative to the scene file, instead of '" + key +
               "'. Lines before the first number and comments after '#' are skipped."},
          {key + " columns", "1, 2", Kind::text,
           "Columns of that file with " + std::string(names).replace(names.find(" : "), 3, " and ") +
               ", from 1."}};
}

std::vector<std::array<double, 2>> PointTable::read(const TypeInput &input, std::string &used_key) const {
  const std::string file = key + " file", columns = key + " columns";
  used_key = input.text(file).empty() ? key : file;
  if (used_key == file) {
    if (input.is_set(key))
      input.reject(key, "no value: the points come from '" + file + "'");
    return read_columns(input, file, columns);
  }
  if (input.is_set(columns))
    input.reject(columns, "no value: there is no '" + file + "'");
  return read_pairs(input, key, names);
}

} // namespace billet
