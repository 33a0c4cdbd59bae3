// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_comparison.h"

#include "billet/errors.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>
#include <utility>

namespace billet {

namespace {

std::vector<std::string> split(const std::string &line) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');)
    parts.push_back(part);
  return parts;
}

/// Returns the value at a time, linear between rows and constant beyond them.
double value_at(const std::vector<double> &times, const std::vector<double> &values, const double time) {
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  if (next == times.begin())
    return values.front();
  if (next == times.end())
    return values.back();
  const auto i = static_cast<std::size_t>(next - times.begin());
  const double part = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return (1. - part) * values[i - 1] + part * values[i];
}

/// Returns ∫Σ|a − b| dt and ∫Σ|b| dt over these columns of both.
std::pair<double, double> integrate(const HistoryTable &a, const HistoryTable &b,
                                    const std::vector<std::string> &names) {
  std::vector<double> times;
  std::set_union(a.times().begin(), a.times().end(), b.times().begin(), b.times().end(),
                 std::back_inserter(times));
  double difference = 0., size = 0.;
  for (const std::string &name : names) {
    const std::vector<double> &of_a = a.column(name), &of_b = b.column(name);
    for (std::size_t i = 0; i < times.size(); ++i) { // trapezoids
      const double before = i > 0 ? times[i - 1] : times[i],
                   after = i + 1 < times.size() ? times[i + 1] : times[i];
      const double weight = 0.5 * (after - before), value = value_at(b.times(), of_b, times[i]);
      difference += weight * std::abs(value_at(a.times(), of_a, times[i]) - value);
      size += weight * std::abs(value);
    }
  }
  return {difference, size};
}

} // namespace

HistoryTable::HistoryTable(std::vector<std::string> names, std::vector<std::vector<double>> columns)
    : names_(std::move(names)), columns_(std::move(columns)), times_(column("time")) {}

HistoryTable HistoryTable::read(const std::string &file_name) {
  std::ifstream file(file_name);
  std::string line;
  if (!std::getline(file, line))
    throw InputError("'" + file_name + "' cannot be read");
  std::vector<std::string> names = split(line);
  std::vector<std::vector<double>> columns(names.size());
  while (std::getline(file, line)) {
    const std::vector<std::string> values = split(line);
    if (values.size() == names.size())
      for (std::size_t i = 0; i < values.size(); ++i)
        columns[i].push_back(std::strtod(values[i].c_str(), nullptr));
  }
  HistoryTable table(std::move(names), std::move(columns));
  if (table.times().empty())
    throw InputError("'" + file_name + "' has no rows with a time");
  return table;
}

const std::vector<double> &HistoryTable::column(const std::string &name) const {
  static const std::vector<double> none;
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? none : columns_[static_cast<std::size_t>(found - names_.begin())];
}

HistoryTable HistoryTable::from_zero() const {
  if (times_.empty() || !(times_.front() > 0.))
    return *this;
  std::vector<std::vector<double>> columns = columns_;
  for (std::vector<double> &column : columns)
    column.insert(column.begin(), 0.);
  return {names_, columns};
}

HistoryDifference compare_histories(const HistoryTable &first, const HistoryTable &second,
                                    const bool has_inertia, const double reach) {
  const HistoryTable a = has_inertia ? first : first.from_zero(),
                     b = has_inertia ? second : second.from_zero();
  const auto compare = [&](const std::string &pattern) {
    const std::regex regex(pattern);
    std::vector<std::string> names;
    for (const std::string &name : b.names())
      if (std::regex_match(name, regex) && !a.column(name).empty())
        names.push_back(name);
    return integrate(a, b, names);
  };
  const std::string reactions = R"(.*\.(support|symmetry plane) .*\.)", given = R"(.*\.load .*\.)",
                    of_contacts = "(?!" + reactions + "|" + given + R"().*\.)";
  struct Group {
    std::string what, pattern;
    std::string moments, of_moments; ///< in place of it, and their pattern; empty: none
  };
  const std::vector<Group> groups = {
      {"forces", of_contacts + "force_[xyz]", "moments", of_contacts + "moment_[xyz]"},
      {"reactions", reactions + "force_[xyz]", "moments of supports", reactions + "moment_[xyz]"},
      {"energies", "elastic_energy|plastic_work|friction_dissipation|kinetic_energy", "", ""},
      {"travel of tools", R"(.*\.travel_[xyz])", "", ""}};
  constexpr double far = 1e3; // a force makes a moment of no more than itself times the reach
  HistoryDifference largest;
  for (const Group &group : groups) {
    if (has_inertia && group.what != "energies")
      continue;
    auto [difference, size] = compare(group.pattern);
    std::string what = group.what;
    if (!group.moments.empty())
      if (const auto [of_moments, moments] = compare(group.of_moments); moments > far * reach * size) {
        difference = of_moments;
        size = moments;
        what = group.moments;
      }
    if (size > 0. && (largest.of_what.empty() || difference / size > largest.part))
      largest = {difference / size, what};
  }
  return largest;
}

} // namespace billet
