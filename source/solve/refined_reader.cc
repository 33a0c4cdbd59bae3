// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/refined_reader.h"

#include "billet/contact/friction_history.h"
#include "billet/contact/spring_energy.h"
#include "billet/errors.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

namespace billet {

namespace {

constexpr const char *refined_bodies_entry = "refined bodies", *nodes_of_elements = "nodes of elements",
                     *friction_areas = "friction areas", *shallow_areas = "shallow areas";

bool is_among(const std::vector<std::string> &names, const std::string &name) {
  return std::any_of(names.begin(), names.end(),
                     [&name](const std::string &start) { return name.rfind(start, 0) == 0; });
}

/// Entries of values at nodes, which the finite element interpolates. Here and below are the
/// beginnings of names that end with a number.
bool is_nodal(const std::string &name) {
  static const std::vector<std::string> names{
      "displacements", "increment", "velocities", "accelerations", "held ", "support start ", "positions"};
  return is_among(names, name);
}

/// Entries of forces at nodes. They are computed anew on another mesh, or are 0.
bool is_force(const std::string &name) {
  static const std::vector<std::string> names{"support forces", "internal forces", "contact forces",
                                              "load forces",    "forces",          "imbalance",
                                              "support fade "};
  return is_among(names, name);
}

/// Entries that depend on the distribution of the mesh before, and may be left out.
bool is_left_out(const std::string &name) {
  return name == "shares of loads" || name == "couplings of" || name == "probe";
}

/// Entries of contact at nodes.
bool is_of_slaves(const std::string &name) {
  static const std::vector<std::string> names{"gaps", "pressed", "friction", "behind", "touched", "lifts"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Row of a node of the mesh before, and its weight.
struct WeightedRow {
  const double *row;
  double weight;
};

/// Returns the sum of a number over these rows.
double sum_up(const std::vector<WeightedRow> &rows, const std::size_t place) {
  double sum = 0.;
  for (const WeightedRow &of : rows)
    sum += of.weight * of.row[place];
  return sum;
}

/// Combines rows of FrictionHistory: the traction in space, in the frame of the nearest node that
/// has one.
void combine_friction(const std::vector<WeightedRow> &rows, const double *const nearest, double *const row) {
  FrictionHistory history, of_row;
  double active = 0.;
  dealii::Tensor<1, 3> traction;
  for (const WeightedRow &of : rows) {
    RowReader reader(of.row, FrictionHistory::width);
    of_row.load(reader);
    if (!of_row.is_active)
      continue;
    if (!(active > 0.) || of.row == nearest)
      history = of_row;
    active += of.weight;
    traction += of.weight * (of_row.tangential[0] * of_row.frame.q + of_row.tangential[1] * of_row.frame.r);
  }
  constexpr double most = 0.5; // of the weights: then the node touches, too
  history.is_active = active >= most;
  if (history.is_active)
    history.tangential = {traction * history.frame.q, traction * history.frame.r};
  else
    history.tangential = {};
  constexpr std::size_t slip = FrictionHistory::width - 2;
  history.slip = sum_up(rows, slip);
  history.slip_rate = sum_up(rows, slip + 1);
  std::vector<double> numbers;
  RowWriter writer(numbers);
  history.save(writer);
  std::copy(numbers.begin(), numbers.end(), row);
}

/// Combines the rows of one entry. `is_part`: whether the node is of a refined body, around which
/// facets have a quarter of their area.
void combine_slaves(const std::string &name, const std::size_t width, const std::vector<WeightedRow> &rows,
                    const bool is_part, double *const row) {
  const double *const nearest =
      std::max_element(rows.begin(), rows.end(), [](const WeightedRow &a, const WeightedRow &b) {
        return a.weight < b.weight;
      })->row;
  if (name == "behind" || name == "touched") { // flags, and keys of facets
    std::copy_n(nearest, width, row);
    return;
  }
  for (std::size_t k = 0; k < width; ++k)
    row[k] = rows.size() == 1 ? nearest[k] : sum_up(rows, k);
  constexpr std::size_t patch = 1; // of "gaps"
  if (name == "gaps")
    row[patch] = nearest[patch];
  if (name == "friction" && rows.size() > 1)
    combine_friction(rows, nearest, row);
  constexpr std::size_t slave_width = FrictionHistory::width + 1, pressed_width = 6, area = 2;
  constexpr double quarter = 0.25;
  if (is_part && name == "friction" && width == slave_width)
    row[width - 1] *= quarter;
  if (is_part && name == "pressed" && width == pressed_width)
    row[area] *= quarter;
}

bool is_of_elements(const std::string &name) {
  return name == "history" || name == "mesh errors of elements";
}

} // namespace

std::array<double, n_element_nodes> weights_in_parent(const unsigned int child, const unsigned int v) {
  std::array<double, n_element_nodes> weights{};
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    weights[a] = 1.;
    for (unsigned int i = 0; i < 3; ++i) {
      const double x = 0.5 * ((child >> i & 1U) + (v >> i & 1U));
      weights[a] *= (a >> i & 1U) != 0 ? x : 1. - x;
    }
  }
  return weights;
}

unsigned int child_number(const ElementKey key) {
  const ElementKey parent = parent_key(key);
  for (unsigned int child = 0; child < n_element_nodes; ++child)
    if (child_key(parent, child) == key)
      return child;
  return 0;
}

void save_mesh(StateWriter &writer, const Discretization &discretization) {
  const NodeKeys node_keys(discretization);
  std::vector<std::uint64_t> keys;
  std::vector<double> rows; // keys of nodes have fewer bits than a double keeps
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body)
    for (const Element &element : discretization.elements(body)) {
      keys.push_back(element_key(element.cell));
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        rows.push_back(static_cast<double>(node_keys(element.dofs[std::size_t{3} * a])));
    }
  writer.write_rows(nodes_of_elements, n_element_nodes, keys, rows);
}

RefinedReader::RefinedReader(StateReader &before, const Discretization &discretization,
                             std::vector<bool> is_refined)
    : before_(before), is_refined_(std::move(is_refined)) {
  find_coarse_cells(discretization);
  before_.in("mesh", [&] { read_parents(discretization); });
}

void RefinedReader::find_coarse_cells(const Discretization &discretization) {
  // merge_bodies() numbers the cells of one body after those of another.
  first_cells_.assign(discretization.n_bodies(), std::numeric_limits<std::uint64_t>::max());
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body)
    for (const Element &element : discretization.elements(body))
      first_cells_[body] = std::min(first_cells_[body], coarse_cell_of(element_key(element.cell)));
  MPI_Allreduce(MPI_IN_PLACE, first_cells_.data(), static_cast<int>(first_cells_.size()), MPI_UINT64_T,
                MPI_MIN, discretization.communicator());
}

void RefinedReader::read_parents(const Discretization &discretization) {
  std::set<ElementKey> wanted;
  for (const auto &cell : discretization.dof_handler().active_cell_iterators())
    if (!cell->is_artificial() && is_refined_[cell->material_id()])
      wanted.insert(parent_key(element_key(cell)));
  const std::vector<std::uint64_t> keys(wanted.begin(), wanted.end());
  const std::vector<double> rows = before_.read_rows(nodes_of_elements, n_element_nodes, keys);
  for (std::size_t i = 0; i < keys.size(); ++i)
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      parents_[keys[i]][a] = static_cast<std::uint64_t>(rows[n_element_nodes * i + a]);
}

bool RefinedReader::is_refined(const ElementKey key) const {
  const auto next = std::upper_bound(first_cells_.begin(), first_cells_.end(), coarse_cell_of(key));
  return is_refined_[static_cast<std::size_t>(next - first_cells_.begin()) - 1];
}

bool RefinedReader::has(const std::string &name) const {
  return name == refined_bodies_entry || (!is_left_out(name) && before_.has(name));
}

std::vector<double> RefinedReader::read(const std::string &name) const {
  if (name != refined_bodies_entry)
    return before_.read(name);
  return {is_refined_.begin(), is_refined_.end()};
}

std::vector<double> RefinedReader::read_rows(const std::string &name, const std::size_t width,
                                             const std::vector<std::uint64_t> &keys,
                                             std::vector<bool> *const found) const {
  if (is_of_elements(name))
    return read_parent_rows(name, width, keys);
  if (is_force(name))
    return drop_forces(name, width, keys);
  if (is_nodal(name))
    return interpolate(name, width, keys);
  if (is_of_slaves(name))
    return read_slaves(name, width, keys, found);
  if (name == friction_areas || name == shallow_areas)
    return read_areas(name, width, keys);
  return before_.read_rows(name, width, keys, found);
}

RefinedReader::Sources RefinedReader::sources_of(const std::uint64_t node) const {
  const ElementKey element = node / n_element_nodes;
  if (!is_refined(element))
    return {{node, 1.}};
  const auto weights =
      weights_in_parent(child_number(element), static_cast<unsigned int>(node % n_element_nodes));
  const NodesOfElement &nodes = parents_.at(parent_key(element));
  Sources sources;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    if (weights[a] > 0.)
      sources.emplace_back(nodes[a], weights[a]);
  return sources;
}

std::vector<double> RefinedReader::interpolate(const std::string &name, const std::size_t width,
                                               const std::vector<std::uint64_t> &keys) const {
  std::vector<Sources> all;
  std::vector<std::uint64_t> before;
  for (const std::uint64_t key : keys)
    for (const auto &source : all.emplace_back(sources_of(key)))
      before.push_back(source.first);
  const std::vector<double> rows = before_.read_rows(name, width, before);
  std::vector<double> result(width * keys.size(), 0.);
  const double *row = rows.data();
  for (std::size_t i = 0; i < keys.size(); ++i)
    for (const auto &source : all[i]) {
      for (std::size_t k = 0; k < width; ++k)
        result[width * i + k] += source.second * row[k];
      row += width;
    }
  return result;
}

std::vector<double> RefinedReader::read_slaves(const std::string &name, const std::size_t width,
                                               const std::vector<std::uint64_t> &keys,
                                               std::vector<bool> *const found) const {
  std::vector<Sources> all;
  std::vector<std::uint64_t> before;
  for (const std::uint64_t key : keys)
    for (const auto &source : all.emplace_back(sources_of(key)))
      before.push_back(source.first);
  std::vector<bool> is_known;
  const std::vector<double> rows = before_.read_rows(name, width, before, &is_known);
  std::vector<double> result(width * keys.size(), 0.);
  if (found != nullptr)
    found->assign(keys.size(), false);
  for (std::size_t i = 0, next = 0; i < keys.size(); ++i) {
    std::vector<WeightedRow> known;
    for (const auto &source : all[i]) {
      if (is_known[next])
        known.push_back({&rows[width * next], source.second});
      ++next;
    }
    if (known.empty() && found == nullptr)
      throw InputError("its '" + name + "' lacks a node of a contact pair");
    if (known.empty())
      continue;
    if (found != nullptr)
      (*found)[i] = true;
    combine_slaves(name, width, known, is_refined(keys[i] / n_element_nodes), &result[width * i]);
  }
  return result;
}

std::vector<double> RefinedReader::read_areas(const std::string &name, const std::size_t width,
                                              const std::vector<std::uint64_t> &keys) const {
  constexpr std::uint64_t n_faces = dealii::GeometryInfo<3>::faces_per_cell;
  std::vector<std::uint64_t> before;
  for (const std::uint64_t key : keys)
    before.push_back(is_refined(key / n_faces) ? n_faces * parent_key(key / n_faces) + key % n_faces : key);
  std::vector<bool> is_known;
  std::vector<double> rows = before_.read_rows(name, width, before, &is_known);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (!is_refined(keys[i] / n_faces))
      continue;
    double sum = 0.;
    for (std::size_t k = 0; k < width; ++k)
      sum += rows[width * i + k];
    // The facet is a quarter of the one before, and its corners share alike.
    std::fill_n(&rows[width * i], width,
                name == shallow_areas ? SpringEnergy::no_area : sum / (4. * static_cast<double>(width)));
  }
  return rows;
}

std::vector<double> RefinedReader::drop_forces(const std::string &name, const std::size_t width,
                                               const std::vector<std::uint64_t> &keys) const {
  std::vector<std::uint64_t> kept;
  for (const std::uint64_t key : keys)
    if (!is_refined(key / n_element_nodes))
      kept.push_back(key);
  const std::vector<double> rows = before_.read_rows(name, width, kept);
  std::vector<double> result(width * keys.size(), 0.);
  for (std::size_t i = 0, next = 0; i < keys.size(); ++i)
    if (!is_refined(keys[i] / n_element_nodes))
      std::copy_n(&rows[width * next++], width, &result[width * i]);
  return result;
}

std::vector<double> RefinedReader::read_parent_rows(const std::string &name, const std::size_t width,
                                                    const std::vector<std::uint64_t> &keys) const {
  std::vector<std::uint64_t> parents;
  for (const std::uint64_t key : keys)
    parents.push_back(is_refined(key) ? parent_key(key) : key);
  return before_.read_rows(name, width, parents);
}

} // namespace billet
