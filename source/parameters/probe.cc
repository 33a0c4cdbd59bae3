// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/probe.h"

#include "billet/nearest_name.h"
#include "billet/parameters/registered.h"

#include <algorithm>

namespace billet::parameters {

namespace {

/// Returns the columns that the console shows.
std::vector<std::string> read_console(const Reader &reader, const billet::Probe &probe) {
  const std::vector<std::string> columns = probe.columns(), wanted = reader.parts("Console", ',');
  if (wanted.size() == 1 && wanted[0] == "all")
    return columns;
  for (const std::string &name : wanted)
    if (std::find(columns.begin(), columns.end(), name) == columns.end()) {
      constexpr std::size_t max_shown = 12;
      std::string list;
      for (std::size_t i = 0; i < std::min(columns.size(), max_shown); ++i)
        list += (i == 0 ? "" : ", ") + columns[i];
      reader.reject("Console", "nothing, all, or columns of this probe, separated by commas: " + list +
                                   (columns.size() > max_shown ? ", ..." : "") + did_you_mean(name, columns));
    }
  return wanted;
}

} // namespace

std::string Probe::full_name(const std::string &column) const {
  std::string result = name + "." + column;
  std::replace_if(
      result.begin(), result.end(), [](const char c) { return c == ',' || c == '"'; }, '_');
  return result;
}

void Probe::declare(dealii::ParameterHandler &prm) {
  declare_selection(prm, "Type", "point", probe_types(), "What the probe reads.");
  prm.declare_entry("Console", "", dealii::Patterns::Anything(),
                    "Columns that the console shows, too, separated by commas, as in history.csv but without "
                    "the probe's name; 'all' shows all of them. Empty: none.");
}

void Probe::parse(Reader &reader) {
  type = reader.text("Type");
  origin = reader.origin();
  origin_of_quantities = reader.origin("Quantities");
  origin_of_energy = reader.origin("Energy");
  probe = make_selected(reader, "Type", probe_types());
  body = reader.located("Body", reader.text("Body"));
  boundary_ids = reader.boundaries("Boundary ids");
  if (probe.has_faces() && boundary_ids.is_empty())
    reader.reject("Boundary ids", "at least one boundary id");
  opposite_ids = reader.boundaries("Opposite boundary ids");
  if (std::holds_alternative<ProbedThickness>(probe.where) && opposite_ids.is_empty())
    reader.reject("Opposite boundary ids", "at least one boundary id");
  console = read_console(reader, probe);
}

} // namespace billet::parameters
