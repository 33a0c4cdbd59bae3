// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/contact_review.h"

#include "billet/diagnostic_kinds.h"
#include "billet/scene/plausibility.h"
#include "billet/solve/solution_energies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <type_traits>

namespace billet {

namespace {

/// Part of the deformation that penetration may take without a warning.
constexpr double notable_softness = 0.04;

/// Spread of forces over nodes that counts as resolved.
struct SpreadLimits {
  /// Square of the sum of pressures over n times the sum of squares, above which they are alike.
  static constexpr double alike = 0.9;
  /// Minimum number of nodes that bear as much as the effective ones, for a contact that is not
  /// uniform.
  static constexpr double enough = 5.;
  /// Indentation, as part of the deformation, below which the number of nodes does not matter.
  static constexpr double counts = 0.05;
  /// Force over its maximum so far, below which that maximum is past. The second number is the part
  /// of all energy that the deformation at the maximum has at least. Lesser maxima are those of
  /// waves before the impact's own.
  static constexpr double past = 0.5, of_all_energy = 0.1;
  /// Part of the force on curves with coarse facets above which they are reported.
  static constexpr double much = 0.5;
  /// The same, above which the error of the mesh is unknown: the direction of that force may be
  /// wrong.
  static constexpr double some = 0.1;
};

/// Whether a node is on a curve of the tool with fewer than five facets on a quarter turn.
bool is_on_coarse_curve(const ContactNodeReport &node) {
  constexpr double coarse = dealii::numbers::PI / 10.; // facet size / radius
  return node.facet_size * node.curvature > coarse;
}

/// Returns a part in per cent.
std::string print_part(const double part) {
  std::ostringstream text;
  text.precision(3);
  text << std::round(1000. * part) / 10.;
  return text.str();
}

} // namespace

bool ForceSpread::is_uniform() const {
  return nodes >= 3. && pressures * pressures > SpreadLimits::alike * nodes * pressure_squares;
}

bool ForceSpread::has_few_nodes() const {
  return force > 0. && effective_nodes() < SpreadLimits::enough && !is_uniform() &&
         indentation > SpreadLimits::counts * deformation;
}

double ContactReview::Pair::part_on_coarse() const {
  return std::max(spread.part_on_coarse(), impulse > 0. ? impulse_on_coarse / impulse : 0.);
}

bool ContactReview::Pair::is_coarse_on_curves() const { return part_on_coarse() > SpreadLimits::much; }

ContactReview::ContactReview(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), tool_forces_(scene.tools().size()),
      stick_springs_(scene, discretization) {
  const auto add = [this](const auto &pair, const std::vector<std::size_t> &bodies, const std::size_t tool,
                          const bool is_self_contact) {
    Pair added;
    added.name = pair.name;
    added.bodies = bodies;
    added.tool = tool;
    added.may_stay_open = is_self_contact || pair.input->is_generated;
    added.is_augmented = pair.is_augmented();
    added.is_softer_tangentially = pair.tangential_penalty < pair.normal_penalty;
    pairs_.push_back(added);
  };
  for (const auto &pair : scene.pairs())
    add(pair, {pair.body}, pair.tool, false);
  for (const auto &pair : scene.body_pairs())
    add(pair, {pair.bodies[0], pair.bodies[1]}, none, pair.is_self_contact);
  paths_ = find_load_paths(scene);
  softness_.resize(paths_.size());

  const double tolerance = Constraint::rounding * discretization.radius();
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> box(6, -infinity); // −low, high
    for (const auto &element : discretization.elements(b))
      for (const unsigned int v : element.cell->vertex_indices()) {
        const auto &X = element.cell->vertex(v);
        Images images;
        for (const Constraint &constraint : scene.bodies()[b].constraints)
          if (constraint.on_plane)
            (std::abs(X * constraint.normal - constraint.offset) > tolerance ? images.apart : images.on_it) *=
                2.;
        images_[element.dofs[std::size_t{3} * v]] = images;
        for (unsigned int i = 0; i < 3; ++i) {
          box[i] = std::max(box[i], -X[i]);
          box[3 + i] = std::max(box[3 + i], X[i]);
        }
      }
    dealii::Utilities::MPI::max(box, discretization.communicator(), box);
    std::array<double, 3> extents{};
    for (unsigned int i = 0; i < 3; ++i)
      extents[i] = box[i] + box[3 + i];
    std::sort(extents.begin(), extents.end());
    sections_.push_back(extents[1] * extents[2]);
  }
}

ForceSpread ContactReview::spread_of(const Pair &pair, const std::vector<ContactNodeReport> &reports) const {
  double young_modulus = std::numeric_limits<double>::infinity();
  for (const std::size_t body : pair.bodies)
    young_modulus = std::min(young_modulus, scene_.bodies()[body].young_modulus);

  // Nodes at the boundary between ranks have parts of their areas on several ranks.
  Vector additive = discretization_.make_additive_vector();
  for (const auto &node : reports) {
    additive(node.dofs[0]) += node.pressure * node.area;
    additive(node.dofs[1]) += node.area;
  }
  additive.compress(dealii::VectorOperation::add);
  Vector sums = discretization_.make_owned_vector();
  sums = additive;
  std::vector<double> own(7);
  for (const auto &node : reports) {
    if (!discretization_.owned_dofs().is_element(node.dofs[0]))
      continue;
    const double force = sums(node.dofs[0]), area = sums(node.dofs[1]);
    if (!(force > 0.) || !(area > 0.))
      continue;
    const auto [images, on_it] = images_.at(node.dofs[0]);
    const double pressure = force / area;
    own[0] += images * force;
    own[1] += images * force * force;
    // On the axis of a wedge two nodes are at one place.
    const double counts =
        scene_.whole_section().kind == WholeSection::Kind::full_circle && on_it > 2. ? 0.5 : 1.;
    own[2] += counts;
    own[3] += counts * pressure;
    own[4] += counts * pressure * pressure;
    if (is_on_coarse_curve(node))
      own[5] += images * force;
    own[6] += 0.5 * on_it * force * force / (young_modulus * node.facet_size);
  }
  dealii::Utilities::MPI::sum(own, discretization_.communicator(), own);
  return {own[0], own[1], own[2], own[3], own[4], own[5], own[6]};
}

void ContactReview::add_on_curves(const std::vector<std::vector<ContactNodeReport>> &reports,
                                  const double time) {
  std::vector<double> forces(2 * pairs_.size()), coarsest(pairs_.size());
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    for (const auto &node : reports[p]) {
      const double force = node.pressure * node.area;
      if (!(force > 0.))
        continue;
      forces[2 * p] += force;
      forces[2 * p + 1] += is_on_coarse_curve(node) ? force : 0.;
      coarsest[p] = std::max(coarsest[p], node.facet_size * node.curvature);
    }
  dealii::Utilities::MPI::sum(forces, discretization_.communicator(), forces);
  dealii::Utilities::MPI::max(coarsest, discretization_.communicator(), coarsest);
  const double elapsed = std::isnan(time_) ? 0. : time - time_;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    pairs_[p].impulse += elapsed * forces[2 * p];
    pairs_[p].impulse_on_coarse += elapsed * forces[2 * p + 1];
    pairs_[p].coarsest = std::max(pairs_[p].coarsest, coarsest[p]);
  }
  time_ = time;
}

DiagnosticList ContactReview::add(const Solution &solution) {
  constexpr double grown = 1.02; // of the force: then the nodes are evaluated again
  DiagnosticList diagnostics;
  if (pairs_.empty())
    return diagnostics;
  const SolutionState &state = solution.state();
  for (std::size_t i = 0; i < tool_forces_.size(); ++i)
    tool_forces_[i] = std::max(tool_forces_[i], state.tool_loads[i].force.norm());
  const auto reports = solution.report_contacts();
  const std::vector<StickSoftness> sticking = stick_springs_.measure(reports);
  const std::vector<double> penetrations = energies_of_penetration(reports, discretization_.communicator());
  add_on_curves(reports, state.time);
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    Pair &pair = pairs_[p];
    const double force = sticking[p].pressure;
    if (!pair.is_augmented) {
      // Augmentation stiffens the springs; judge_paths() reports softness of both.
      pair.max_friction.friction = std::max(pair.max_friction.friction, sticking[p].friction);
      pair.max_friction.lost = std::max(pair.max_friction.lost, sticking[p].lost);
    }
    // Crossing edges bear forces, too, without slave nodes.
    const std::size_t n_with_tools = scene_.pairs().size();
    const double of_all = p < n_with_tools ? 0. : state.body_pair_loads[p - n_with_tools].force.norm();
    pair.has_touched = pair.has_touched || force > 0. || of_all > 0.;
    pair.max_of_edges = std::max(pair.max_of_edges, of_all - force);
    if (force < SpreadLimits::past * pair.max_force &&
        pair.spread.deformation > SpreadLimits::of_all_energy * state.energies.total()) {
      const DiagnosticList few = judge_spread(pair);
      pair.is_spread_reported = pair.is_spread_reported || !few.empty();
      append(diagnostics, few);
    }
    if (!(force > grown * pair.max_force))
      continue;
    pair.max_force = force;
    pair.time = state.time;
    pair.spread = spread_of(pair, reports[p]);
    const EnergyLedger &energies = state.energies;
    pair.spread.deformation = energies.of_elements() + energies.contact;
  }
  const EnergyLedger &ledger = state.energies;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    double penetration = 0., deformation = ledger.of_elements();
    for (const std::size_t pair : paths_[i].pairs)
      penetration += penetrations[pair];
    if (paths_[i].bodies.size() < scene_.bodies().size()) {
      const auto energies = energies_of_bodies(solution, paths_[i].bodies, discretization_.communicator());
      deformation = std::accumulate(energies.begin(), energies.end(), 0.);
    }
    const double all = paths_[i].bears_given_loads ? ledger.total() : ledger.of_elements() + ledger.contact;
    if (std::isfinite(penetration + deformation + all))
      softness_[i].add(state.time, penetration, deformation, all);
  }
  return diagnostics;
}

double ContactReview::penalty_error() const {
  double worst = 0.;
  for (std::size_t i = 0; i < paths_.size(); ++i)
    worst = std::max(worst, softness_[i].part());
  return worst > notable_softness ? worst : 0.;
}

std::string ContactReview::describe_unresolved() const {
  if (std::any_of(pairs_.begin(), pairs_.end(), [](const Pair &pair) {
        return pair.is_spread_reported || pair.spread.has_few_nodes() || pair.is_coarse_on_curves();
      }))
    return "the mesh does not resolve the contact that warnings name";
  const auto worst = std::max_element(pairs_.begin(), pairs_.end(), [](const Pair &a, const Pair &b) {
    return a.part_on_coarse() < b.part_on_coarse();
  });
  if (worst == pairs_.end() || !(worst->part_on_coarse() > SpreadLimits::some))
    return "";
  std::ostringstream text;
  text.precision(2);
  text << 100. * worst->part_on_coarse() << " % of the force of the pair '" << worst->name
       << "' acts where a quarter turn of the tool has fewer than five facets";
  return text.str();
}

void ContactReview::judge_paths(DiagnosticList &diagnostics) const {
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const double part = softness_[i].part();
    if (!(part > notable_softness))
      continue;
    std::string names;
    std::size_t first = none;
    for (const std::size_t pair : paths_[i].pairs)
      if (pairs_[pair].has_touched)
        first = std::min(first, pair);
    for (const std::size_t pair : paths_[i].pairs)
      if (pairs_[pair].has_touched)
        names += (names.empty() ? "'" : ", '") + pairs_[pair].name + "'";
    constexpr double all = 0.99;
    std::ostringstream text;
    text.precision(3);
    text << "Penetration takes " << (part > all ? "more than 99" : print_part(part))
         << " % of the deformation along the load path of " << names << ": ";
    if (part > all)
      text << "the bodies hardly deform, and the penalties alone determine forces and displacements";
    else
      text << "forces of driven tools and supports are too small by about that part, or displacements under "
              "given loads "
           << 1. / (1. - part) << " times too large";
    Diagnostic message(diagnostic::contact_too_soft, text.str());
    message.pair(pairs_[first != none ? first : paths_[i].pairs.front()].name).measure("part", part);
    if (part <= all)
      message.value("factor", 1. / (1. - part));
    diagnostics.push_back(message);
  }
}

DiagnosticList ContactReview::judge_spread(const Pair &pair) {
  if (pair.is_spread_reported || !pair.spread.has_few_nodes())
    return {};
  std::ostringstream text;
  text.precision(2);
  text << "At the maximum of the force, it acts on the equivalent of " << pair.spread.effective_nodes()
       << " nodes, including mirror images";
  return {Diagnostic(diagnostic::few_contact_nodes, text.str())
              .pair(pair.name)
              .time(pair.time)
              .value("nodes", pair.spread.effective_nodes())};
}

void ContactReview::judge_pairs(DiagnosticList &diagnostics) const {
  for (std::size_t t = 0; t < scene_.tools().size(); ++t) {
    const auto is_of_tool = [t](const Pair &pair) { return pair.tool == t; };
    if (std::none_of(pairs_.begin(), pairs_.end(),
                     [&](const Pair &pair) { return is_of_tool(pair) && pair.has_touched; })) {
      const Tool &tool = scene_.tools()[t];
      std::ostringstream text;
      text << "No step ends with a force on the tool";
      const bool is_removed = std::isfinite(tool.removal_time());
      if (is_removed)
        text << " before its removal at time " << tool.removal_time();
      Diagnostic message(diagnostic::tool_without_force, text.str());
      if (is_removed)
        message.advice("Check its position and motion; if it acts earlier, reduce 'Initial step' so that "
                       "steps end earlier");
      diagnostics.push_back(message.tool(tool.name()));
    }
  }
  if (std::any_of(pairs_.begin(), pairs_.end(),
                  [](const Pair &pair) {
                    return pair.tool == none && pair.bodies[0] != pair.bodies[1] && pair.may_stay_open;
                  }) &&
      std::none_of(pairs_.begin(), pairs_.end(), [](const Pair &pair) { return pair.has_touched; }))
    diagnostics.emplace_back(diagnostic::pair_never_touched, "No pair has contact in the whole run");
  std::vector<bool> is_reported(pairs_.size(), false); // reported as too soft, including friction
  for (std::size_t i = 0; i < paths_.size(); ++i)
    for (const std::size_t pair : paths_[i].pairs)
      is_reported[pair] = softness_[i].part() > notable_softness && !pairs_[pair].is_softer_tangentially;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const Pair &pair = pairs_[p];
    const bool has_idle_tool =
        pair.tool != none && std::none_of(pairs_.begin(), pairs_.end(), [&](const Pair &other) {
          return other.tool == pair.tool && other.has_touched;
        });
    if (!pair.has_touched && !pair.may_stay_open && !has_idle_tool)
      diagnostics.push_back(
          Diagnostic(diagnostic::pair_never_touched, "The pair has no contact in the whole run")
              .pair(pair.name));
    append(diagnostics, judge_spread(pair));
    if (pair.max_of_edges > pair.max_force) {
      std::ostringstream text;
      text.precision(3);
      text << "Crossing edges carry up to " << pair.max_of_edges
           << ", with two nodes on each side; all nodes on facets carry at most " << pair.max_force;
      diagnostics.push_back(
          Diagnostic(diagnostic::few_contact_nodes, text.str()).pair(pair.name).value("nodes", 2.));
    }
    if (pair.is_coarse_on_curves()) {
      std::ostringstream text;
      text.precision(3);
      text << "Facets that bear " << 100. * pair.part_on_coarse()
           << " % of the force, at its maximum or over the run, have up to " << pair.coarsest
           << " times the tool's radius or width there";
      diagnostics.push_back(Diagnostic(diagnostic::coarse_on_tool, text.str())
                                .pair(pair.name)
                                .time(pair.time)
                                .measure("facet size / radius", pair.coarsest));
    }
    constexpr double allowed = 0.03, counts = 0.002; // of friction, and of the normal force
    const double lost = pair.max_friction.lost, part = pair.max_friction.part();
    if (!is_reported[p] && part > allowed && lost > counts * pair.max_force) {
      std::ostringstream text;
      text.precision(3);
      text << "The tangential penalty is too low: friction forces while sticking are too small by up to "
           << 100. * part << " %";
      diagnostics.push_back(Diagnostic(diagnostic::tangential_penalty_too_low, text.str())
                                .pair(pair.name)
                                .measure("lost friction / friction", part)
                                .value("lost friction / normal force", lost / pair.max_force));
    }
  }
}

void ContactReview::judge_forces(DiagnosticList &diagnostics) const {
  for (std::size_t t = 0; t < tool_forces_.size(); ++t) {
    double borne = 0.; // by the strongest body that it may touch
    for (const Pair &pair : pairs_)
      if (pair.tool == t)
        borne = std::max(borne,
                         borne_force(scene_.bodies()[pair.bodies.front()], sections_[pair.bodies.front()]));
    if (borne > 0. && tool_forces_[t] > many_times_borne * borne) {
      std::ostringstream text;
      text.precision(3);
      text << "The tool exerts up to " << tool_forces_[t] << ", which is " << tool_forces_[t] / borne
           << " times what the largest section of the body bears as it yields";
      diagnostics.push_back(Diagnostic(diagnostic::implausible_force, text.str())
                                .tool(scene_.tools()[t].name())
                                .measure("force / (yield stress x section)", tool_forces_[t] / borne));
    }
  }
}

DiagnosticList ContactReview::finish() const {
  DiagnosticList diagnostics;
  judge_paths(diagnostics);
  judge_pairs(diagnostics);
  judge_forces(diagnostics);
  return diagnostics;
}

bool ContactReview::self_contact_touches() const {
  return std::any_of(pairs_.begin(), pairs_.end(), [](const Pair &pair) {
    return pair.tool == none && pair.bodies[0] == pair.bodies[1] && pair.has_touched;
  });
}

void ContactReview::save(StateWriter &writer) const {
  std::vector<double> numbers = tool_forces_;
  for (const auto &softness : softness_)
    softness.save(numbers);
  for (const Pair &pair : pairs_)
    numbers.insert(numbers.end(),
                   {pair.has_touched ? 1. : 0., pair.max_force, pair.time, pair.spread.force,
                    pair.spread.squares, pair.spread.nodes, pair.spread.pressures,
                    pair.spread.pressure_squares, pair.spread.on_coarse_curves, pair.spread.indentation,
                    pair.spread.deformation, pair.max_friction.friction, pair.max_friction.lost,
                    pair.max_of_edges, pair.is_spread_reported ? 1. : 0., pair.impulse,
                    pair.impulse_on_coarse, pair.coarsest});
  numbers.push_back(time_);
  writer.write("contact review", numbers);
}

void ContactReview::load(const StateReader &reader) {
  constexpr std::size_t of_pair = 18;
  const std::vector<double> numbers = reader.read("contact review");
  if (numbers.size() !=
      tool_forces_.size() + PathSoftness::n_numbers * softness_.size() + of_pair * pairs_.size() + 1) {
    time_ = std::nan(""); // saved for other pairs
    return;
  }
  const double *next = numbers.data();
  for (double &force : tool_forces_)
    force = *next++;
  for (auto &softness : softness_) {
    softness.load(next);
    next += PathSoftness::n_numbers;
  }
  for (Pair &pair : pairs_) {
    pair.has_touched = next[0] > 0.;
    pair.max_force = next[1];
    pair.time = next[2];
    pair.spread = {next[3], next[4], next[5], next[6], next[7], next[8], next[9], next[10]};
    pair.max_friction.friction = next[11];
    pair.max_friction.lost = next[12];
    pair.max_of_edges = next[13];
    pair.is_spread_reported = next[14] > 0.;
    pair.impulse = next[15];
    pair.impulse_on_coarse = next[16];
    pair.coarsest = next[17];
    next += of_pair;
  }
  time_ = *next;
}

} // namespace billet
