// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/tensor_columns.h"
#include "billet/nearest_name.h"
#include "billet/probes/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

ProbeType point_type();
ProbeType path_type();
ProbeType set_type();
ProbeType thickness_type();
ProbeType draw_in_type();
ProbeType energy_ratio_type();
ProbeType body_type();

TypeTable<Probe> &probe_types() {
  static TypeTable<Probe> types{point_type(),   path_type(),         set_type(), thickness_type(),
                                draw_in_type(), energy_ratio_type(), body_type()};
  return types;
}

namespace {

struct NamedStatistic {
  ProbeStatistic statistic;
  std::string name;
};

const std::vector<NamedStatistic> &named_statistics() {
  static const std::vector<NamedStatistic> all{{ProbeStatistic::each, "each"},
                                               {ProbeStatistic::least, "least"},
                                               {ProbeStatistic::largest, "largest"},
                                               {ProbeStatistic::mean, "mean"},
                                               {ProbeStatistic::sum, "sum"}};
  return all;
}

/// Returns those of `all` that the parameter names, separated by commas, each once.
template <class Named>
std::vector<Named> read_names(const TypeInput &input, const std::string &key, const std::vector<Named> &all) {
  std::vector<std::string> names;
  std::string list;
  for (const Named &one : all) {
    names.push_back(one.name);
    list += (list.empty() ? "" : ", ") + one.name;
  }
  std::vector<Named> result;
  for (const std::string &name : input.parts(key, ',')) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      input.reject(key, "a list of " + list + ", separated by commas" + did_you_mean(name, names));
    if (std::any_of(result.begin(), result.end(), [&](const Named &one) { return one.name == name; }))
      input.reject(key, "a list without repetition; '" + name + "' stands there twice");
    result.push_back(all[static_cast<std::size_t>(found - names.begin())]);
  }
  if (result.empty())
    input.reject(key, "a list of " + list + ", separated by commas");
  return result;
}

double evaluate_statistic(const ProbeStatistic statistic, const std::vector<std::vector<double>> &values,
                          const std::vector<double> &weights, const std::size_t component) {
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  double sum = 0., weighted = 0., weight = 0.;
  for (std::size_t site = 0; site < values.size(); ++site) {
    const double value = values[site][component];
    if (std::isnan(value))
      continue;
    least = std::min(least, value);
    largest = std::max(largest, value);
    sum += value;
    weighted += weights[site] * value;
    weight += weights[site];
  }
  if (!(weight > 0.))
    return std::numeric_limits<double>::quiet_NaN();
  switch (statistic) {
  case ProbeStatistic::least:
    return least;
  case ProbeStatistic::largest:
    return largest;
  case ProbeStatistic::mean:
    return weighted / weight;
  case ProbeStatistic::sum:
  case ProbeStatistic::each:
    break;
  }
  return sum;
}

} // namespace

const std::vector<ProbeQuantity> &probe_quantities() {
  using Kind = ProbeQuantity::Kind;
  static const std::vector<ProbeQuantity> all{
      {Kind::displacement,
       "displacement",
       {"displacement_x", "displacement_y", "displacement_z", "displacement_magnitude"}},
      {Kind::velocity, "velocity", {"velocity_x", "velocity_y", "velocity_z", "velocity_magnitude"}},
      {Kind::position, "position", {"position_x", "position_y", "position_z"}},
      {Kind::stress, "stress", stress_columns()},
      {Kind::strain, "strain", strain_columns()},
      {Kind::plastic_strain, "plastic strain", {"equivalent_plastic_strain"}},
      {Kind::contact_pressure, "contact pressure", {"contact_pressure"}}};
  return all;
}

bool Probe::reads(const ProbeQuantity::Kind kind) const {
  return std::any_of(quantities.begin(), quantities.end(),
                     [kind](const ProbeQuantity &quantity) { return quantity.kind == kind; });
}

namespace {

// One function for each alternative of Probe::where: the compiler finds a missing one.
using Names = std::vector<std::string>;

bool reads_faces(const ProbedPoints &) { return false; }
bool reads_faces(const ProbedFaces &) { return true; }
bool reads_faces(const ProbedThickness &) { return true; }
bool reads_faces(const ProbedTravel &) { return true; }
bool reads_faces(const ProbedEnergies &) { return false; }
bool reads_faces(const ProbedMotion &) { return false; }

Names components_of(const std::vector<ProbeQuantity> &quantities) {
  Names names;
  for (const ProbeQuantity &quantity : quantities)
    names.insert(names.end(), quantity.components.begin(), quantity.components.end());
  return names;
}
Names components_of(const Probe &probe, const ProbedPoints &) { return components_of(probe.quantities); }
Names components_of(const Probe &probe, const ProbedFaces &) { return components_of(probe.quantities); }
Names components_of(const Probe &, const ProbedThickness &) { return {"thickness"}; }
Names components_of(const Probe &, const ProbedTravel &) { return {"draw_in"}; }
Names components_of(const Probe &, const ProbedEnergies &) { return {"ratio"}; }
Names components_of(const Probe &, const ProbedMotion &) {
  return {"velocity_x", "velocity_y", "velocity_z",     "momentum_x",
          "momentum_y", "momentum_z", "kinetic_energy", "internal_energy"};
}

/// Number of sites whose values `each` writes; 0: the probe has no sites.
std::size_t count_sites(const ProbedPoints &points) { return points.points.size(); }
std::size_t count_sites(const ProbedFaces &) { return 1; }
std::size_t count_sites(const ProbedThickness &) { return 1; }
std::size_t count_sites(const ProbedTravel &) { return 1; }
std::size_t count_sites(const ProbedEnergies &) { return 0; }
std::size_t count_sites(const ProbedMotion &) { return 0; }

} // namespace

bool Probe::has_faces() const {
  return std::visit([](const auto &place) { return reads_faces(place); }, where);
}

std::vector<std::string> Probe::components() const {
  return std::visit([this](const auto &place) { return components_of(*this, place); }, where);
}

std::vector<std::string> Probe::columns() const {
  const std::vector<std::string> names = components();
  const std::size_t n_each = std::visit([](const auto &place) { return count_sites(place); }, where);
  if (n_each == 0)
    return names;
  std::vector<std::string> columns;
  for (const ProbeStatistic statistic : statistics) {
    const std::size_t n_sites = statistic == ProbeStatistic::each ? n_each : 1;
    const auto named = std::find_if(named_statistics().begin(), named_statistics().end(),
                                    [&](const auto &one) { return one.statistic == statistic; });
    for (std::size_t site = 0; site < n_sites; ++site)
      for (const std::string &name : names)
        columns.push_back(statistic != ProbeStatistic::each ? named->name + "_" + name
                          : names_sites                     ? std::to_string(site + 1) + "." + name
                                                            : name);
  }
  return columns;
}

namespace {

/// Returns for each component whether it is a contact pressure.
std::vector<bool> find_contact_pressures(const Probe &probe) {
  std::vector<bool> are_pressures;
  for (const ProbeQuantity &quantity : probe.quantities)
    are_pressures.insert(are_pressures.end(), quantity.components.size(),
                         quantity.kind == ProbeQuantity::Kind::contact_pressure);
  are_pressures.resize(probe.components().size(), false); // of probes without quantities
  return are_pressures;
}

double mean_pressure(const std::vector<std::vector<double>> &values, const std::vector<double> &areas,
                     const std::size_t component) {
  double force = 0., area = 0.;
  for (std::size_t site = 0; site < values.size(); ++site) {
    force += areas[site] * values[site][component];
    area += areas[site];
  }
  return area > 0. ? force / area : 0.;
}

} // namespace

std::vector<double> evaluate_columns(const Probe &probe, const std::vector<std::vector<double>> &values,
                                     const SiteWeights &weights) {
  const std::vector<bool> are_pressures = find_contact_pressures(probe);
  std::vector<double> columns;
  for (const ProbeStatistic statistic : probe.statistics) {
    if (statistic == ProbeStatistic::each) {
      for (const auto &at_site : values)
        columns.insert(columns.end(), at_site.begin(), at_site.end());
      continue;
    }
    for (std::size_t c = 0; c < are_pressures.size(); ++c)
      columns.push_back(statistic == ProbeStatistic::mean && are_pressures[c] &&
                                !weights.contact_areas.empty()
                            ? mean_pressure(values, weights.contact_areas, c)
                            : evaluate_statistic(statistic, values, weights.all, c));
  }
  return columns;
}

TypeParameter probed_body() {
  return {"Body", "", TypeParameter::Kind::text,
          "Name of the body. Empty: the only one; a scene with several has to name it."};
}

TypeParameter probed_faces() {
  return {"Boundary ids", "", TypeParameter::Kind::text,
          "Boundary ids or names of the faces, separated by commas."};
}

TypeParameter probed_point() {
  return {"Point", "", TypeParameter::Kind::text,
          "Point 'x, y, z'. Of a thickness: where it is measured; empty, at all faces. [length]"};
}

TypeParameter probed_place() {
  return {"Place", "material", TypeParameter::Kind::choice,
          "material|nearest node|space: Points that the probe reads. material: points of the undeformed "
          "body, which move with it. nearest node: the nodes nearest to them. space: points that stay in "
          "space and read what is there, 'nan' if nothing is."};
}

TypeParameter probed_quantities() {
  std::string list;
  for (const ProbeQuantity &quantity : probe_quantities())
    list += (list.empty() ? "" : ", ") + quantity.name;
  return {"Quantities", "displacement", TypeParameter::Kind::text,
          "List of " + list +
              ", separated by commas. Stress and strains are those at the face or point, with the bending of "
              "its element."};
}

TypeParameter probed_statistics() {
  return {"Values", "least, largest, mean", TypeParameter::Kind::text,
          "List of least, largest, mean, sum and, for paths, each, separated by commas. Means over faces and "
          "their nodes have undeformed areas as weights."};
}

std::vector<TypeParameter> with_probed_axes(std::vector<TypeParameter> parameters) {
  for (const TypeParameter &parameter : Axes::parameters())
    parameters.push_back(parameter);
  return parameters;
}

ProbedPoints::Place read_place(const TypeInput &input) {
  const std::string place = input.text("Place");
  if (place == "space")
    return ProbedPoints::Place::space;
  if (place == "nearest node")
    return ProbedPoints::Place::nearest_node;
  if (place != "material")
    input.reject("Place", "material, nearest node or space");
  return ProbedPoints::Place::material;
}

std::vector<ProbeQuantity> read_quantities(const TypeInput &input) {
  return read_names(input, "Quantities", probe_quantities());
}

std::vector<ProbeStatistic> read_statistics(const TypeInput &input, const bool may_list_sites) {
  std::vector<ProbeStatistic> statistics;
  for (const NamedStatistic &one : read_names(input, "Values", named_statistics())) {
    if (one.statistic == ProbeStatistic::each && !may_list_sites)
      input.reject("Values", "a list of least, largest, mean, sum: only a path lists each of its points");
    statistics.push_back(one.statistic);
  }
  return statistics;
}

} // namespace billet
