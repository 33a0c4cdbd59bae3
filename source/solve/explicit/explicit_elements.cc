// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_elements.h"

#include "billet/fail_together.h"
#include "billet/forces/law_refusals.h"
#include "billet/solve/refined_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace billet {

namespace {

/// Returns the formulation of a body's elements.
ExplicitFormulation formulation_of(const parameters::Scene &scene, const parameters::Body &body) {
  const auto &dynamics = scene.explicit_dynamics;
  ExplicitFormulation formulation;
  formulation.element = body.element.value.type;
  formulation.constants = body.element.value.constants;
  formulation.linear_viscosity = dynamics.linear_viscosity;
  formulation.quadratic_viscosity = dynamics.quadratic_viscosity;
  formulation.instructions = dynamics.instructions;
  formulation.number_type = dynamics.number_type;
  return formulation;
}

} // namespace

ExplicitElements::ExplicitElements(const Scene &scene, const LocalNodes &nodes)
    : scene_(scene), nodes_(nodes) {
  fail_together(nodes.discretization().communicator(), [this] { make_blocks(); });
  count_memory();
}

void ExplicitElements::make_blocks() {
  for (std::size_t b = 0; b < scene_.bodies().size(); ++b) {
    const Body &body = scene_.bodies()[b];
    const auto &input = scene_.parameters().bodies[b];
    try {
      blocks_.push_back(
          make_explicit_block(body.law, body.density, formulation_of(scene_.parameters(), input)));
    } catch (const std::invalid_argument &error) {
      throw InputError(input.origin + ": " + error.what());
    }
    std::size_t offender = 0;
    if (!blocks_.back()->initialize(nodes_.elements(b), nodes_.positions().data(), offender)) {
      std::ostringstream message;
      message << input.origin << ": the element with its centre at ("
              << nodes_.discretization().elements(b)[offender].cell->center()
              << ") is degenerate or inverted; allowed are hexahedra with a positive Jacobian";
      throw InputError(message.str());
    }
  }
}

void ExplicitElements::count_memory() {
  std::size_t plastic = 0, stabilised = 0; // bytes
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (scene_.bodies()[b].law->has_plasticity())
      plastic += blocks_[b]->history_memory();
    stabilised += blocks_[b]->stabilisation_memory();
  }
  plastic_memory_.set(plastic);
  stabilised_memory_.set(stabilised);
}

std::vector<double> ExplicitElements::lumped_masses() const {
  std::vector<double> masses(nodes_.size(), 0.);
  for (const auto &block : blocks_)
    block->add_masses(masses.data());
  return masses;
}

double ExplicitElements::scale_mass(const double min_step) {
  double added = 0.;
  for (const auto &block : blocks_)
    added += block->scale_mass(min_step);
  return added;
}

double ExplicitElements::stable_step_of(const std::size_t body, const std::size_t begin,
                                        const std::size_t end, const double min_step) const {
  const Body &of_scene = scene_.bodies()[body];
  const std::unique_ptr<ExplicitBlock> block = make_explicit_block(
      of_scene.law, of_scene.density, formulation_of(scene_.parameters(), scene_.parameters().bodies[body]));
  const auto &elements = nodes_.elements(body);
  std::size_t offender = 0; // remains: make_blocks() has refused elements that offend
  block->initialize({elements.begin() + static_cast<std::ptrdiff_t>(begin),
                     elements.begin() + static_cast<std::ptrdiff_t>(end)},
                    nodes_.positions().data(), offender);
  if (min_step > 0.)
    block->scale_mass(min_step);
  if (of_scene.temperature)
    block->set_temperature(of_scene.temperature->value(0.));
  const NodalVectors at_rest = nodes_.make_vectors();
  NodalVectors forces = nodes_.make_vectors();
  return block->advance({at_rest.data(), at_rest.data(), forces.data()}, 0.).stable_step;
}

LimitingElement ExplicitElements::find_limiting_element(const double min_step) const {
  LimitingElement limiting;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (blocks_[b]->size() > 0) {
      const double step = stable_step_of(b, 0, blocks_[b]->size(), min_step);
      if (step < limiting.step)
        limiting = {b, 0, step};
    }
  if (!std::isfinite(limiting.step))
    return limiting;
  // Kernels return the shortest step of all their elements: halve these until one is left.
  std::size_t begin = 0, end = blocks_[limiting.body]->size();
  while (end - begin > 1) {
    const std::size_t middle = begin + (end - begin) / 2;
    const double first = stable_step_of(limiting.body, begin, middle, min_step);
    if (first <= stable_step_of(limiting.body, middle, end, min_step))
      end = middle;
    else
      begin = middle;
  }
  limiting.element = begin;
  return limiting;
}

SolutionFailure ExplicitElements::describe_inverted(const std::size_t body, const std::size_t element,
                                                    const double *displacements,
                                                    const ExplicitClock &clock) const {
  dealii::Point<3> centre, at_start;
  for (const unsigned int node : nodes_.elements(body)[element]) {
    at_start += 0.125 * get_vector(nodes_.positions().data(), node);
    centre += 0.125 * (get_vector(nodes_.positions().data(), node) + get_vector(displacements, node));
  }
  std::ostringstream why;
  why << "element " << nodes_.discretization().elements(body)[element].cell->global_active_cell_index()
      << " of body '" << scene_.bodies()[body].name << "', with its initial centre at (" << at_start
      << "), is ";
  const std::string refusal = describe_refusal(*scene_.bodies()[body].law);
  if (!refusal.empty())
    why << "without a stress: " << refusal;
  else if (std::isfinite(centre.norm()))
    why << "inverted at (" << centre << ")";
  else
    why << "not finite in its coordinates";
  return clock.failure({why.str(), !refusal.empty() ? "'billet --certify' tries the law out"
                                   : std::isfinite(centre.norm())
                                       ? "Try a smaller 'Safety factor', more bulk viscosity, a lower "
                                         "penalty or a less distorted mesh there"
                                       : "Check the units of velocities, loads and penalties"});
}

void ExplicitElements::set_temperatures(const double t) {
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (const auto &temperature = scene_.bodies()[b].temperature)
      blocks_[b]->set_temperature(temperature->value(t));
}

double ExplicitElements::add_forces(const ExplicitBlock::Nodes &nodes, const ExplicitClock &clock,
                                    ExplicitWorks &works) {
  ++ElementLoops::of_forces;
  double stable_step = std::numeric_limits<double>::infinity();
  elastic_energy_ = hourglass_energy_ = 0.;
  set_temperatures(clock.time());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto result = blocks_[b]->advance(nodes, clock.since_forces());
    if (result.inverted < blocks_[b]->size())
      throw describe_inverted(b, result.inverted, nodes.displacements, clock);
    if (!clock.is_at_start() && clock.n_steps() % ExplicitBlock::renewal_interval == 0)
      blocks_[b]->renew(nodes.displacements);
    const Body &body = scene_.bodies()[b];
    Usage::count_if(body.law->has_plasticity(), Capability::plasticity, blocks_[b]->size());
    Usage::count_if(body.formulation.element.is_stabilised(), Capability::stabilisation, blocks_[b]->size());
    stable_step = std::min(stable_step, result.stable_step);
    elastic_energy_ += result.elastic_energy;
    works.plastic += result.plastic_work;
    works.viscous += result.viscous_work;
    hourglass_energy_ += result.hourglass_energy;
  }
  return stable_step;
}

std::vector<ElementSummary> ExplicitElements::summarize(const std::size_t body,
                                                        const NodalVectors &displacements) const {
  std::vector<ElementSummary> summaries;
  for (std::size_t e = 0; e < blocks_[body]->size(); ++e)
    summaries.push_back(blocks_[body]->summarize(e, displacements.data()));
  return summaries;
}

std::vector<StateAverages> ExplicitElements::average_states(const std::size_t body,
                                                            const NodalVectors &displacements) const {
  std::vector<StateAverages> averages;
  for (std::size_t e = 0; e < blocks_[body]->size(); ++e)
    averages.push_back(blocks_[body]->average_states(e, displacements.data()));
  return averages;
}

std::vector<ElementPoints> ExplicitElements::element_points(const std::size_t body,
                                                            const NodalVectors &displacements) const {
  std::vector<ElementPoints> result;
  for (std::size_t e = 0; e < blocks_[body]->size(); ++e)
    result.push_back({blocks_[body]->compute_stress(e, displacements.data())});
  return result;
}

std::size_t ExplicitElements::history_size() const {
  std::size_t size = 0;
  for (const auto &block : blocks_)
    size += block->history_memory() / sizeof(double);
  return size;
}

HistoryFormat ExplicitElements::history_format(const std::size_t body) const {
  return format_of(formulation_of(scene_.parameters(), scene_.parameters().bodies[body]),
                   *scene_.bodies()[body].law);
}

void ExplicitElements::save(StateWriter &writer) const {
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    writer.in(group("body", b), [&] {
      const ExplicitBlock &block = *blocks_[b];
      save_format(writer, history_format(b));
      const std::size_t width = block.history_size();
      std::vector<double> rows(width * block.size());
      for (std::size_t e = 0; e < block.size(); ++e)
        block.get_state(e, rows.data() + width * e);
      if (block.point_states().n_points > 0)
        save_fields(writer, *scene_.bodies()[b].law);
      writer.write_rows("history", width, element_keys(nodes_.discretization(), b), rows);
    });
}

bool ExplicitElements::has_same_formulations(StateReader &reader) const {
  bool are_same = true;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    reader.in(group("body", b), [&] { are_same = are_same && load_format(reader) == history_format(b); });
  return are_same;
}

void ExplicitElements::load(StateReader &reader, const double t, const NodalVectors &displacements) {
  set_temperatures(t);
  const std::vector<bool> are_refined = refined_bodies(reader);
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    reader.in(group("body", b), [&] {
      const std::size_t width = blocks_[b]->history_size();
      const Body &body = scene_.bodies()[b];
      const auto rows = load_history(reader, body.name, *body.law, blocks_[b]->point_states(), width,
                                     element_keys(nodes_.discretization(), b));
      if (!are_refined.empty() && are_refined[b]) {
        load_parents(b, rows, displacements);
        return;
      }
      for (std::size_t e = 0; e < blocks_[b]->size(); ++e)
        blocks_[b]->set_state(e, rows.data() + width * e);
    });
}

void ExplicitElements::load_parents(const std::size_t body, const std::vector<double> &rows,
                                    const NodalVectors &displacements) {
  ExplicitBlock &block = *blocks_[body];
  const std::size_t width = block.history_size();
  for (std::size_t e = 0; e < block.size(); ++e) {
    const CellIterator &cell = nodes_.discretization().elements(body)[e].cell;
    ParentElement parent{{}, rows.data() + width * e, child_number(element_key(cell))};
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        parent.positions[3 * a + i] = cell->parent()->vertex(a)[i];
    block.set_parent_state(e, parent, displacements.data());
  }
  block.renew(displacements.data());
}

void ExplicitElements::load_stresses(StateReader &reader, const NodalVectors &displacements,
                                     const Vector &ghosted, const double t) {
  set_temperatures(t);
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    reader.in(group("body", b), [&] {
      const auto stresses = load_stress(reader, scene_, b, nodes_.discretization(), ghosted, t);
      for (std::size_t e = 0; e < blocks_[b]->size(); ++e)
        blocks_[b]->set_stress(e, displacements.data(), stresses[e]);
    });
}

} // namespace billet
