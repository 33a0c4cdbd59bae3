// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/restart.h"

#include "billet/discretization/local_nodes.h"
#include "billet/errors.h"
#include "billet/material/elasticity.h"
#include "billet/material/state_fields.h"
#include "billet/parameters/material_texts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace billet {

namespace {

/// Returns the number of elements, the volume, and Σ w centre. The weight in [0, 1) belongs to the
/// element's key, so that a different numbering is detected.
std::vector<double> measure(const Discretization &discretization, const std::size_t body) {
  std::array<double, 5> own{};
  for (const auto &element : discretization.elements(body)) {
    std::uint64_t mixed = (element_key(element.cell) + 1) * 0x9e3779b97f4a7c15U;
    mixed ^= mixed >> 31U;
    const double weight = static_cast<double>(mixed % 1000003U) / 1000003.;
    own[0] += 1.;
    own[1] += element.cell->measure();
    for (unsigned int i = 0; i < 3; ++i)
      own[2 + i] += weight * element.cell->center()[i];
  }
  MPI_Allreduce(MPI_IN_PLACE, own.data(), 5, MPI_DOUBLE, MPI_SUM, discretization.communicator());
  return {own.begin(), own.end()};
}

/// Returns the law of this elasticity with the constants of `law`; null if there is none.
SharedLaw find_law(const std::string &elasticity, const SharedLaw &law) {
  if (law->name() == elasticity)
    return law;
  const ElasticityType *type = elasticity_types().find(elasticity);
  return type == nullptr ? nullptr : type->find_law(law->elastic(), law->shared_flow_stress());
}

std::optional<BrickElement> find_element(const std::string &name) {
  const ElementType *type = element_types().find(name);
  return type == nullptr ? std::optional<BrickElement>() : type->element;
}

constexpr const char *explicit_method = "explicit", *implicit_method = "implicit", *in_float = "float",
                     *in_double = "double";

constexpr std::uint64_t max_ranks = 1U << 20U;

constexpr const char *constants_entry = "element constants";
constexpr const char *level_entry = "level"; // of a body's mesh

/// Returns the fields that save_fields() has written; none if there were none.
std::vector<StateField> read_fields(const StateReader &reader) {
  std::vector<StateField> fields;
  if (!reader.has("fields"))
    return fields;
  std::istringstream lines(reader.read_text("fields"));
  StateField field;
  while (lines >> field.n_components && std::getline(lines >> std::ws, field.name))
    fields.push_back(field);
  return fields;
}

/// Returns, for each number of a law's state, its place among the numbers of the same fields in
/// another order. Returns nothing if they are not the same fields.
std::optional<std::vector<std::size_t>> find_places(const std::vector<StateField> &then,
                                                    const std::vector<StateField> &now) {
  std::vector<std::size_t> places;
  for (const StateField &field : now) {
    std::size_t place = 0;
    auto other = then.begin();
    for (; other != then.end() && other->name != field.name; ++other)
      place += other->n_components;
    if (other == then.end() || other->n_components != field.n_components)
      return {};
    for (std::size_t k = 0; k < field.n_components; ++k)
      places.push_back(place + k);
  }
  if (then.size() != now.size())
    return {};
  return places;
}

} // namespace

HistoryFormat format_of(const ElementFormulation &formulation, const PointLaw &law) {
  return {implicit_method, formulation.element.name(), law.name(),
          in_double,       formulation.points_through, formulation.constants};
}

HistoryFormat format_of(const ExplicitFormulation &formulation, const PointLaw &law) {
  const bool is_float = formulation.number_type == NumberType::float_precision;
  return {explicit_method,      formulation.element.name(), law.name(), is_float ? in_float : in_double, 2,
          formulation.constants};
}

void save_format(StateWriter &writer, const HistoryFormat &format) {
  writer.write_text("method", format.method);
  writer.write_text("element", format.element);
  writer.write_text("elasticity", format.elasticity);
  writer.write_text("number type", format.number_type);
  writer.write("points through", {static_cast<double>(format.points_through)});
  if (!format.constants.empty())
    writer.write(constants_entry, format.constants);
}

HistoryFormat load_format(const StateReader &reader) {
  return {reader.read_text("method"),
          reader.read_text("element"),
          reader.read_text("elasticity"),
          reader.read_text("number type"),
          to_count(reader.number("points through")),
          reader.has(constants_entry) ? reader.read(constants_entry) : std::vector<double>()};
}

namespace {

/// Writes each parameter with a line for its name and one for its value.
std::string join_lines(const parameters::MaterialTexts &material) {
  std::string lines;
  for (const auto &[key, value] : material)
    lines += key + "\n" + value + "\n";
  return lines;
}

parameters::MaterialTexts split_lines(const std::string &text) {
  parameters::MaterialTexts material;
  std::istringstream lines(text);
  std::string key, value;
  while (std::getline(lines, key) && std::getline(lines, value))
    material[key] = value;
  return material;
}

/// Adds "'Yield stress' of body 'cube' (300, now 900)" for each parameter that is not as in the
/// checkpoint.
void describe_changes(const std::vector<parameters::ChangedParameter> &parameters, const std::string &body,
                      std::vector<std::string> &changed) {
  for (const auto &[key, before, after] : parameters)
    changed.push_back("'" + key + "' of body '" + body + "' (" + before + ", now " + after + ")");
}

} // namespace

void save_scene(StateWriter &writer, const Scene &scene, const Discretization &discretization) {
  writer.write("bodies", {static_cast<double>(scene.bodies().size())});
  for (std::size_t b = 0; b < scene.bodies().size(); ++b)
    writer.in(group("body", b), [&] {
      writer.write_text("name", scene.bodies()[b].name);
      writer.write_text("material", scene.bodies()[b].law->description());
      writer.write_text("material parameters", join_lines(parameters::find_material_texts(
                                                   scene.parameters(), scene.bodies()[b].name)));
      writer.write("mesh", measure(discretization, b));
      writer.write(level_entry, {static_cast<double>(discretization.levels()[b])});
    });
}

MeshLevels load_levels(StateReader &reader, const Scene &scene, const double time) {
  const MeshLevels here = find_mesh_levels(scene.parameters(), time);
  MeshLevels levels(here.size(), 0);
  for (std::size_t b = 0; b < here.size() && reader.has(group("body", b)); ++b)
    reader.in(group("body", b), [&] {
      levels[b] = to_count(reader.number(level_entry), max_refinements);
      if (levels[b] > here[b])
        throw InputError("the elements of its body '" + scene.bodies()[b].name + "' have been divided " +
                         std::to_string(levels[b]) + " times by 'Refinement times', but this scene has " +
                         std::to_string(here[b]) +
                         " of these times until then. Elements are not joined again");
    });
  return levels;
}

std::vector<bool> refined_bodies(const StateReader &reader) {
  constexpr const char *entry = "refined bodies";
  if (!reader.has(entry))
    return {};
  const std::vector<double> flags = reader.read(entry);
  return {flags.begin(), flags.end()};
}

bool is_refined(const StateReader &reader, const ContactInterface &contact) {
  const std::vector<bool> are_refined = refined_bodies(reader);
  return !are_refined.empty() && std::any_of(contact.bodies().begin(), contact.bodies().end(),
                                             [&](const std::size_t body) { return are_refined[body]; });
}

double refinement_release_time(const parameters::Scene &parameters) {
  constexpr double short_part = 0.1; // half as long takes more iterations, twice as long few less
  return parameters.restart.release_time > 0. ? parameters.restart.release_time
                                              : short_part * parameters.time_stepping.end_time;
}

double end_of_fading(const parameters::Scene &parameters, const double time) {
  return std::min(parameters.time_stepping.end_time, time + refinement_release_time(parameters));
}

std::vector<std::string> check_scene(StateReader &reader, const Scene &scene,
                                     const Discretization &discretization) {
  std::vector<std::string> changed;
  const double n_bodies = reader.number("bodies");
  if (n_bodies != static_cast<double>(scene.bodies().size()))
    throw InputError("it has " + std::to_string(std::lround(n_bodies)) + " bodies, but this scene has " +
                     std::to_string(scene.bodies().size()));
  for (std::size_t b = 0; b < scene.bodies().size(); ++b)
    reader.in(group("body", b), [&] {
      const Body &body = scene.bodies()[b];
      const std::string name = reader.read_text("name"), material = reader.read_text("material");
      if (name != body.name)
        throw InputError("its body " + std::to_string(b + 1) + " is '" + name + "', but here it is '" +
                         body.name + "'");
      if (material != body.law->description())
        throw InputError("its body '" + name + "' is " + material + ", but here it is " +
                         body.law->description());
      describe_changes(
          parameters::compare_materials(split_lines(reader.read_text("material parameters")),
                                        parameters::find_material_texts(scene.parameters(), name)),
          name, changed);
      const std::vector<double> then = reader.read("mesh", 5), now = measure(discretization, b);
      if (then.at(0) != now[0])
        throw InputError("its body '" + name + "' has " + std::to_string(std::lround(then[0])) +
                         " elements, but here it has " + std::to_string(std::lround(now[0])));
      // They may contain round-off of another machine.
      constexpr double tolerance = 1e-9;
      const double radius = discretization.radius() + discretization.centre().norm();
      bool is_same = std::abs(then.at(1) - now[1]) <= tolerance * now[1];
      for (unsigned int i = 2; i < 5; ++i)
        is_same = is_same && std::abs(then.at(i) - now[i]) <= tolerance * radius * now[0];
      if (!is_same)
        throw InputError("its body '" + name +
                         "' has another mesh: elements have other positions or another order");
    });
  return changed;
}

OwnedNodes::OwnedNodes(const Discretization &discretization, const NodeKeys &node_keys) {
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body)
    for (const auto &element : discretization.elements(body))
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        if (discretization.owned_dofs().is_element(element.dofs[std::size_t{3} * a]))
          first_dofs.push_back(element.dofs[std::size_t{3} * a]);
  std::sort(first_dofs.begin(), first_dofs.end());
  first_dofs.erase(std::unique(first_dofs.begin(), first_dofs.end()), first_dofs.end());
  for (const DofIndex dof : first_dofs)
    keys.push_back(node_keys(dof));
}

void save_nodal(StateWriter &writer, const std::string &name, const OwnedNodes &nodes, const Vector &values) {
  std::vector<double> rows;
  for (const DofIndex dof : nodes.first_dofs)
    for (unsigned int i = 0; i < 3; ++i)
      rows.push_back(values(dof + i));
  writer.write_rows(name, 3, nodes.keys, rows);
}

void load_nodal(const StateReader &reader, const std::string &name, const OwnedNodes &nodes, Vector &values) {
  const std::vector<double> rows = reader.read_rows(name, 3, nodes.keys);
  for (std::size_t n = 0; n < nodes.keys.size(); ++n)
    for (unsigned int i = 0; i < 3; ++i)
      values(nodes.first_dofs[n] + i) = rows[3 * n + i];
  values.compress(dealii::VectorOperation::insert);
}

std::vector<std::uint64_t> element_keys(const Discretization &discretization, const std::size_t body) {
  std::vector<std::uint64_t> keys;
  for (const auto &element : discretization.elements(body))
    keys.push_back(element_key(element.cell));
  return keys;
}

void save_thickness_axes(StateWriter &writer, const ElementBlock &block,
                         const std::vector<std::uint64_t> &keys) {
  std::vector<double> codes;
  for (const auto &axis : block.thickness_axes())
    codes.push_back(axis.code());
  writer.write_rows("thickness axes", 1, keys, codes);
}

std::vector<ThicknessAxis> load_thickness_axes(const StateReader &reader,
                                               const std::vector<std::uint64_t> &keys) {
  std::vector<ThicknessAxis> axes;
  for (const double code : reader.read_rows("thickness axes", 1, keys))
    axes.push_back(ThicknessAxis::from_code(to_count(code, 5U)));
  return axes;
}

void save_fields(StateWriter &writer, const PointLaw &law) {
  std::string lines;
  for (const StateField &field : stored_fields(law))
    lines += std::to_string(field.n_components) + " " + field.name + "\n";
  if (!lines.empty())
    writer.write_text("fields", lines);
}

std::vector<double> load_history(const StateReader &reader, const std::string &body, const PointLaw &law,
                                 const PointStates &points, const std::size_t width,
                                 const std::vector<std::uint64_t> &keys) {
  if (points.n_points == 0)
    return reader.read_rows("history", width, keys);
  const std::vector<StateField> then = read_fields(reader), now = stored_fields(law);
  const auto places = find_places(then, now);
  if (!places)
    throw InputError("the state of the law '" + law.name() + "' of its body '" + body + "' has the fields " +
                     describe(then) + ", but here it has " + describe(now) +
                     ". Resume with the law that wrote the checkpoint, or start at time 0");
  std::vector<double> rows = reader.read_rows("history", width, keys);
  const std::size_t n_state = places->size();
  std::vector<double> state(n_state);
  for (std::size_t row = 0; row < keys.size(); ++row)
    for (std::size_t q = 0; q < points.n_points; ++q) {
      double *const own = rows.data() + row * width + points.first + q * n_state;
      std::copy_n(own, n_state, state.begin());
      for (std::size_t k = 0; k < n_state; ++k)
        own[k] = state[(*places)[k]];
    }
  return rows;
}

namespace {

/// History of a body that another formulation has written.
struct ForeignHistory {
  const StateReader &reader;
  const Body &body;
  const std::vector<Element> &elements;
  HistoryFormat format;
  BrickElement element;
  SharedLaw law;
};

/// Reads the rows of a block's histories, with the keys of its elements.
template <class Block>
std::vector<double> rows_of(const ForeignHistory &history, const Block &block, const std::size_t width,
                            const std::vector<std::uint64_t> &keys) {
  if (width == 0)
    return {};
  return load_history(history.reader, history.body.name, *history.law, block.point_states(), width, keys);
}

std::vector<ElementStress> stress_of_implicit(const ForeignHistory &history,
                                              const std::vector<std::uint64_t> &keys,
                                              const Vector &displacements, const double t) {
  ElementFormulation formulation;
  formulation.element = history.element;
  formulation.points_through = history.format.points_through;
  formulation.constants = history.format.constants;
  const auto block = make_element_block(history.law, formulation);
  std::vector<ElementVectors> positions;
  positions.reserve(history.elements.size());
  for (const auto &element : history.elements)
    positions.push_back(nodal_positions(element.cell));
  std::vector<ThicknessAxis> axes(history.elements.size());
  if (formulation.points_through > 2)
    axes = load_thickness_axes(history.reader, keys);
  std::size_t ignored = 0;
  block->initialize(positions, axes, ignored);
  if (history.body.temperature != nullptr)
    block->set_temperature(history.body.temperature->value(t));
  const std::size_t width = block->state_size();
  const std::vector<double> rows = rows_of(history, *block, width, keys);
  std::vector<ElementStress> stresses;
  stresses.reserve(history.elements.size());
  for (std::size_t e = 0; e < history.elements.size(); ++e) {
    if (width > 0)
      block->set_state(e, &rows[width * e]);
    stresses.push_back(block->compute_stress(e, gather(displacements, history.elements[e].dofs)));
  }
  return stresses;
}

std::vector<ElementStress> stress_of_explicit(const ForeignHistory &history,
                                              const std::vector<std::uint64_t> &keys, const LocalNodes &nodes,
                                              const std::size_t body, const Vector &displacements,
                                              const double t) {
  NodalVectors u = nodes.make_vectors();
  for (unsigned int node = 0; node < nodes.size(); ++node)
    for (unsigned int i = 0; i < 3; ++i)
      u[std::size_t{nodal_stride} * node + i] = displacements(nodes.dofs(node)[i]);
  ExplicitFormulation formulation;
  formulation.instructions = InstructionSet::scalar;
  formulation.element = history.element;
  formulation.constants = history.format.constants;
  if (history.format.number_type == in_float)
    formulation.number_type = NumberType::float_precision;
  const auto block = make_explicit_block(history.law, 1., formulation);
  std::size_t ignored = 0;
  block->initialize(nodes.elements(body), nodes.positions().data(), ignored);
  if (history.body.temperature != nullptr)
    block->set_temperature(history.body.temperature->value(t));
  const std::size_t width = block->history_size();
  const std::vector<double> rows = rows_of(history, *block, width, keys);
  for (std::size_t e = 0; e < history.elements.size(); ++e)
    block->set_state(e, &rows[width * e]);
  std::vector<ElementStress> stresses;
  stresses.reserve(history.elements.size());
  for (std::size_t e = 0; e < history.elements.size(); ++e)
    stresses.push_back(block->compute_stress(e, u.data()));
  return stresses;
}

} // namespace

std::vector<ElementStress> load_stress(const StateReader &reader, const Scene &scene, const std::size_t body,
                                       const Discretization &discretization, const Vector &displacements,
                                       const double t) {
  const HistoryFormat format = load_format(reader);
  const Body &of = scene.bodies()[body];
  const SharedLaw law = find_law(format.elasticity, of.law);
  const std::optional<BrickElement> element = find_element(format.element);
  if (law == nullptr || !element)
    throw InputError("the history of its body '" + of.name + "' has an unknown type: '" +
                     (law == nullptr ? format.elasticity : format.element) + "'");
  const ForeignHistory history{reader, of, discretization.elements(body), format, *element, law};
  const auto keys = element_keys(discretization, body);
  auto stresses = format.method == explicit_method
                      ? stress_of_explicit(history, keys, LocalNodes(discretization), body, displacements, t)
                      : stress_of_implicit(history, keys, displacements, t);
  if (law != of.law) // which remembers other things
    for (ElementStress &element_stress : stresses)
      for (PointStress &point : element_stress)
        point.memory.clear();
  return stresses;
}

std::vector<std::string> group_names(StateReader &reader, const std::string &kind) {
  std::vector<std::string> names;
  while (reader.has(group(kind, names.size())))
    reader.in(group(kind, names.size()), [&] { names.push_back(reader.read_text("name")); });
  return names;
}

std::optional<std::size_t> find_group(StateReader &reader, const std::string &kind, const std::string &name) {
  const auto names = group_names(reader, kind);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    return {};
  return static_cast<std::size_t>(found - names.begin());
}

void compare_parts(StateReader &reader, const Scene &scene, RestartReport &report) {
  const auto compare = [&](const std::string &kind, const std::string &word, std::vector<std::string> now) {
    for (const auto &name : group_names(reader, kind)) {
      const auto found = std::find(now.begin(), now.end(), name);
      if (found == now.end())
        report.gone.push_back(word + " '" + name + "'");
      else
        now.erase(found);
    }
    report.is_exact = report.is_exact && now.empty();
  };
  std::vector<std::string> tools, pairs, body_pairs;
  for (const auto &tool : scene.tools())
    tools.push_back(tool.name());
  for (const auto &pair : scene.pairs())
    pairs.push_back(pair.name);
  for (const auto &pair : scene.body_pairs())
    body_pairs.push_back(pair.name);
  compare("tool", "tool", tools);
  compare("pair", "contact pair", pairs);
  compare("body pair", "contact pair", body_pairs);
  report.is_exact = report.is_exact && report.gone.empty();
}

void save_pair(StateWriter &writer, const ContactInterface &contact) {
  writer.write_text("name", contact.name());
  writer.write_text("partners", contact.partners());
}

bool load_pair(StateReader &reader, const ContactInterface &contact, const std::function<void()> &load) {
  const auto found = find_group(reader, contact.group_kind(), contact.name());
  if (!found)
    return false;
  reader.in(group(contact.group_kind(), *found), [&] {
    const std::string then = reader.read_text("partners");
    if (then != contact.partners())
      throw InputError("its contact pair '" + contact.name() + "' joins " + then + ", but here it joins " +
                       contact.partners() + ". Give a new pair a new name");
    load();
  });
  return true;
}

std::vector<double> to_numbers(const Placement &placement) {
  std::vector<double> numbers;
  RowWriter row(numbers);
  for (unsigned int i = 0; i < 3; ++i)
    row.vector(placement.rotation[i]);
  row.vector(placement.translation).vector(placement.centre).number(placement.rotation_angle);
  return numbers;
}

Placement to_placement(const std::vector<double> &numbers) {
  Placement placement;
  RowReader row(numbers);
  for (unsigned int i = 0; i < 3; ++i) {
    dealii::Tensor<1, 3> line;
    row.vector(line);
    placement.rotation[i] = line;
  }
  row.vector(placement.translation);
  row.vector(placement.centre);
  placement.rotation_angle = row.number();
  return placement;
}

std::vector<double> to_numbers(const ContactLoad &load) {
  std::vector<double> numbers;
  RowWriter(numbers)
      .vector(load.force)
      .vector(load.moment)
      .number(load.area)
      .number(load.stored_energy)
      .number(load.dissipation)
      .number(load.deepest);
  return numbers;
}

ContactLoad to_contact_load(const std::vector<double> &numbers) {
  ContactLoad load;
  RowReader row(numbers);
  row.vector(load.force);
  row.vector(load.moment);
  load.area = row.number();
  load.stored_energy = row.number();
  load.dissipation = row.number();
  load.deepest = row.number();
  return load;
}

std::vector<double> to_numbers(const EnergyLedger &energies) {
  return {energies.initial,  energies.kinetic, energies.elastic,   energies.plastic,   energies.contact,
          energies.friction, energies.viscous, energies.hourglass, energies.numerical, energies.external};
}

EnergyLedger to_energies(const std::vector<double> &numbers) {
  EnergyLedger energies;
  RowReader row(numbers);
  for (double *energy :
       {&energies.initial, &energies.kinetic, &energies.elastic, &energies.plastic, &energies.contact,
        &energies.friction, &energies.viscous, &energies.hourglass, &energies.numerical, &energies.external})
    *energy = row.number();
  return energies;
}

void save_parts(StateWriter &writer, const std::string &name, const unsigned int rank,
                const std::vector<std::uint64_t> &keys, const std::vector<double> &values) {
  std::vector<std::uint64_t> own = keys;
  for (auto &key : own)
    key = key * max_ranks + rank;
  writer.write_rows(name, 3, own, values);
}

std::vector<double> load_part(const StateReader &reader, const std::string &name, const unsigned int rank,
                              const std::vector<std::uint64_t> &keys) {
  std::vector<std::uint64_t> own = keys;
  for (auto &key : own)
    key = key * max_ranks + rank;
  std::vector<bool> found;
  return reader.read_rows(name, 3, own, &found);
}

std::vector<double> load_sums(const StateReader &reader, const std::string &name,
                              const std::vector<std::uint64_t> &keys) {
  std::vector<double> sums(3 * keys.size(), 0.);
  for (unsigned int rank = 0; rank < reader.n_ranks(); ++rank) {
    const std::vector<double> part = load_part(reader, name, rank, keys);
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] += part[i];
  }
  return sums;
}

void save_support_starts(StateWriter &writer, const std::set<double> &times,
                         const std::function<void(const std::string &name, double time)> &save) {
  if (times.empty())
    return;
  writer.write("support starts", {times.begin(), times.end()});
  std::size_t i = 0;
  for (const double time : times)
    save("support start " + std::to_string(i++), time);
}

std::set<double> load_support_starts(const StateReader &reader, const std::set<double> &times,
                                     const std::function<void(const std::string &name, double time)> &load) {
  std::set<double> unknown = times;
  if (!times.empty() && reader.has("support starts")) {
    const std::vector<double> known = reader.read("support starts");
    for (std::size_t i = 0; i < known.size(); ++i)
      if (unknown.erase(known[i]) > 0)
        load("support start " + std::to_string(i), known[i]);
  }
  return unknown;
}

void save_support_fades(StateWriter &writer, const std::vector<FadeTimes> &times,
                        const std::function<void(const std::string &name, std::size_t index)> &save) {
  if (times.empty())
    return;
  std::vector<double> numbers;
  for (const FadeTimes &fade : times) {
    numbers.push_back(fade.begin);
    numbers.push_back(fade.duration);
  }
  writer.write("support fades", numbers);
  for (std::size_t i = 0; i < times.size(); ++i)
    save("support fade " + std::to_string(i), i);
}

void load_support_fades(const StateReader &reader,
                        const std::function<void(const std::string &name, const FadeTimes &times)> &load) {
  if (!reader.has("support fades"))
    return;
  const std::vector<double> numbers = reader.read("support fades");
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
    load("support fade " + std::to_string(i / 2), {numbers[i], numbers[i + 1]});
}

} // namespace billet
