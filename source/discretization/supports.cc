// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/supports.h"

#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/usage.h"

#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace billet {

namespace {

constexpr double little_weight = 1e-14; ///< of a constraint in a combination: round-off
/// Allowed disagreement of prescribed displacements, over the scene's radius.
constexpr double disagreement = 1e-8;

/// Returns what is wrong with prescribed displacements.
std::string describe_contradiction(const Constraint &constraint, const double time,
                                   const dealii::Point<3> &position, const std::string &names,
                                   const double difference) {
  std::ostringstream message;
  message << constraint.origin << ": at time " << time << " the node at (" << position
          << ") has prescribed displacements by " << names << ", which contradict each other by "
          << difference << "; allowed are prescribed displacements that agree where their boundaries meet";
  return message.str();
}

} // namespace

void TangentSystem::add(const dealii::FullMatrix<double> &local, const std::vector<DofIndex> &dofs) const {
  if (weight != 1.) {
    dealii::FullMatrix<double> weighted(local);
    weighted *= weight;
    TangentSystem{constraints, matrix, lift}.add(weighted, dofs);
    return;
  }
  if (lift == nullptr)
    constraints.distribute_local_to_global(local, dofs, matrix);
  else
    constraints.distribute_local_to_global(local, dealii::Vector<double>(dofs.size()), dofs, matrix, *lift);
}

std::map<DofIndex, ConstrainedNode> collect_constrained_nodes(const Scene &scene,
                                                              const Discretization &discretization,
                                                              const ConstraintFilter &acts) {
  // Ghost cells are included: every rank knows all faces around the nodes of its own cells.
  std::map<DofIndex, ConstrainedNode> nodes;
  const double tolerance = Constraint::rounding * discretization.radius();
  const auto add = [&](const Constraint &constraint, const auto &object, const unsigned int v) {
    if (!constraint.has_direction(object->vertex(v), tolerance))
      return;
    auto &node = nodes[object->vertex_dof_index(v, 0)];
    for (unsigned int i = 0; i < 3; ++i)
      node.dofs[i] = object->vertex_dof_index(v, i);
    node.position = object->vertex(v);
    if (std::find(node.constraints.begin(), node.constraints.end(), &constraint) == node.constraints.end())
      node.constraints.push_back(&constraint);
  };
  for (const auto &cell : discretization.dof_handler().active_cell_iterators()) {
    if (cell->is_artificial())
      continue;
    for (const auto &constraint : scene.bodies()[cell->material_id()].constraints)
      if (constraint.nodes && acts(constraint))
        for (const unsigned int v : cell->vertex_indices())
          if (constraint.nodes->contains(cell->vertex(v)))
            add(constraint, cell, v);
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary())
        continue;
      for (const auto &constraint : scene.bodies()[cell->material_id()].constraints) {
        if (!acts(constraint) || !constrains_face(constraint, cell->face(f), tolerance))
          continue;
        for (const unsigned int v : cell->face(f)->vertex_indices())
          add(constraint, cell->face(f), v);
      }
    }
  }
  for (auto &entry : nodes) // The order of a node's planes must not depend on the rank.
    std::sort(entry.second.constraints.begin(), entry.second.constraints.end());
  return nodes;
}

std::set<DofIndex> collect_fixed_nodes(const Scene &scene, const Discretization &discretization) {
  constexpr double independent = 1e-8; // as in eliminate()
  std::set<DofIndex> fixed;
  const auto always = [](const Constraint &constraint) { return constraint.times.always(); };
  for (const auto &[dof, node] : collect_constrained_nodes(scene, discretization, always)) {
    std::vector<dealii::Tensor<1, 3>> basis;
    for (const Constraint *constraint : node.constraints) {
      dealii::Tensor<1, 3> left = constraint->direction(node.position);
      for (const auto &e : basis)
        left -= (left * e) * e;
      if (left.norm() > independent)
        basis.push_back(left / left.norm());
    }
    if (basis.size() == 3)
      fixed.insert(dof);
  }
  return fixed;
}

Supports::Supports(const Scene &scene, const Discretization &discretization)
    : scene_(scene), discretization_(discretization), acting_(scene, holding_after(0.)),
      links_(collect_links(discretization.dof_handler(), discretization.relevant_dofs())) {
  rebuild();
}

void Supports::rebuild() {
  lines_.clear();
  prescriptions_.clear();
  redundancies_.clear();
  const std::map<DofIndex, ConstrainedNode> nodes = collect_constrained_nodes(
      scene_, discretization_, [this](const Constraint &constraint) { return acting_(constraint); });
  fail_together(discretization_.communicator(), [&] {
    for (const auto &entry : nodes)
      eliminate(entry.second);
  });
  homogeneous_ = build({});
  couples_ranks_ = couple_ranks(homogeneous_, discretization_.owned_dofs(), discretization_.communicator());
}

void Supports::release(const double t, const double fade_time) {
  acting_.release(holding_after(t), fade_time);
  acting_.forget_ended(starts_);
  rebuild();
}

void Supports::take(const double t, const Vector &displacements) {
  for (const double time : acting_.take(holding_after(t)))
    starts_.insert_or_assign(time, Vector(displacements)); // a copy keeps the ghosts
  rebuild();
}

void Supports::resume(const double t, std::map<double, Vector> starts) {
  starts_ = std::move(starts);
  acting_.change_to(holding_after(t));
  rebuild();
}

double Supports::start_of(const Constraint &constraint, const ConstrainedNode &node) const {
  if (!constraint.times.is_late())
    return 0.;
  const Vector &start = starts_.at(constraint.times.from);
  const dealii::Tensor<1, 3> n = constraint.direction(node.position);
  double place = 0.;
  for (unsigned int i = 0; i < 3; ++i)
    place += n[i] * start(node.dofs[i]);
  return constraint.value != nullptr ? place - constraint.value->value(constraint.times.from, node.position)
                                     : place;
}

std::vector<ConstraintRow> solve_for_pivots(const ConstrainedNode &node) {
  constexpr double min_pivot = 1e-10; // of unit normals
  const std::vector<const Constraint *> &constraints = node.constraints;
  std::vector<ConstraintRow> rows(constraints.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r].n = constraints[r]->direction(node.position);
    rows[r].weights.assign(constraints.size(), 0.);
    rows[r].weights[r] = 1.;
  }
  for (auto &row : rows) {
    for (unsigned int i = 0; i < 3; ++i) // the largest component is the pivot
      if (row.pivot < 0 || std::abs(row.n[i]) > std::abs(row.n[static_cast<unsigned int>(row.pivot)]))
        row.pivot = static_cast<int>(i);
    const double pivot = row.n[static_cast<unsigned int>(row.pivot)];
    if (std::abs(pivot) < min_pivot) { // this one depends on earlier ones
      row.pivot = -1;
      continue;
    }
    row.n /= pivot;
    for (double &weight : row.weights)
      weight /= pivot;
    for (auto &other : rows)
      if (&other != &row) {
        const double factor = other.n[static_cast<unsigned int>(row.pivot)];
        other.n -= factor * row.n;
        for (std::size_t h = 0; h < constraints.size(); ++h)
          other.weights[h] -= factor * row.weights[h];
      }
  }
  return rows;
}

std::string names_in(const ConstraintRow &row, const ConstrainedNode &node) {
  std::string list;
  for (std::size_t h = 0; h < node.constraints.size(); ++h)
    if (std::abs(row.weights[h]) > little_weight)
      list += (list.empty() ? "'" : " and '") + node.constraints[h]->name + "'";
  return list;
}

void Supports::eliminate(const ConstrainedNode &node) {
  constexpr double min_weight = 1e-14; // of unit normals: round-off
  const std::vector<const Constraint *> &constraints = node.constraints;
  const std::array<DofIndex, 3> &dofs = node.dofs;
  const dealii::Point<3> &position = node.position;
  std::vector<double> starts;
  for (const Constraint *constraint : constraints)
    starts.push_back(start_of(*constraint, node));
  const std::vector<ConstraintRow> rows = solve_for_pivots(node);
  for (const auto &row : rows) {
    std::vector<Term> terms;
    double start = 0.;
    for (std::size_t h = 0; h < constraints.size(); ++h)
      if (std::abs(row.weights[h]) > little_weight) {
        if (constraints[h]->value != nullptr)
          terms.push_back({constraints[h], row.weights[h]});
        start += row.weights[h] * starts[h];
      }
    if (row.pivot < 0) {
      if (!terms.empty())
        redundancies_.push_back({terms, names_in(row, node), position, start});
      continue;
    }
    ConstraintLine line{dofs[static_cast<unsigned int>(row.pivot)], {}};
    for (unsigned int i = 0; i < 3; ++i)
      if (static_cast<int>(i) != row.pivot && std::abs(row.n[i]) > min_weight)
        line.others.emplace_back(dofs[i], -row.n[i]);
    lines_.push_back(line);
    prescriptions_.push_back({terms, position, start});
  }
  std::size_t bytes = 0;
  for (const auto &prescription : prescriptions_)
    bytes += prescription.terms.size() * sizeof(Term);
  moving_memory_.set(bytes);
}

namespace {

/// Constraints of a node that depend on each other, while they act. With those that began at
/// `start` or before they agree there, and from then on their changes have to.
class DependentConstraints {
public:
  DependentConstraints(const ConstraintRow &row, const ConstrainedNode &node)
      : names_(names_in(row, node)), position_(node.position) {
    for (std::size_t h = 0; h < node.constraints.size(); ++h) {
      if (!(std::abs(row.weights[h]) > little_weight))
        continue;
      start_ = std::max(start_, node.constraints[h]->times.from);
      if (node.constraints[h]->value != nullptr)
        terms_.emplace_back(node.constraints[h], row.weights[h]);
    }
  }

  bool have_values() const { return !terms_.empty(); }
  double sum_at(const double t) const {
    double sum = 0.;
    for (const auto &[constraint, weight] : terms_)
      sum += weight * constraint->value->value(t, position_);
    return sum;
  }
  double start() const { return start_; }
  void refuse(const double t, const double difference) const {
    throw InputError(describe_contradiction(*terms_.front().first, t, position_, names_, difference));
  }

private:
  std::vector<std::pair<const Constraint *, double>> terms_;
  std::string names_;
  dealii::Point<3> position_;
  double start_ = 0.;
};

} // namespace

void check_agreement(const Scene &scene, const Discretization &discretization) {
  const double end = scene.parameters().time_stepping.end_time;
  std::set<double> changes{0., end};
  for (const Body &body : scene.bodies())
    for (const Constraint &constraint : body.constraints)
      for (const double time : {constraint.times.from, constraint.times.until})
        if (time > 0. && time < end)
          changes.insert(time);
  for (auto from = changes.begin(); std::next(from) != changes.end(); ++from) {
    std::vector<DependentConstraints> dependent;
    std::vector<std::pair<const Constraint *, dealii::Point<3>>> moving;
    const auto acts = [&](const Constraint &constraint) { return constraint.times.acts_after(*from); };
    for (const auto &entry : collect_constrained_nodes(scene, discretization, acts)) {
      const ConstrainedNode &node = entry.second;
      for (const ConstraintRow &row : solve_for_pivots(node))
        if (row.pivot < 0)
          if (DependentConstraints on_node(row, node); on_node.have_values())
            dependent.push_back(std::move(on_node));
      for (const Constraint *constraint : node.constraints)
        if (constraint->value != nullptr)
          moving.emplace_back(constraint, node.position);
    }
    // One time after the other: an expression is parsed again when the time changes.
    fail_together(discretization.communicator(), [&] {
      check_before_start([&] {
        std::map<double, std::vector<std::size_t>> of_start;
        std::vector<double> sums_at_start(dependent.size(), 0.);
        for (std::size_t i = 0; i < dependent.size(); ++i)
          if (dependent[i].start() > 0.)
            of_start[dependent[i].start()].push_back(i);
        for (const auto &[start, members] : of_start)
          for (const std::size_t i : members)
            sums_at_start[i] = dependent[i].sum_at(start);
        constexpr unsigned int n_checks = 16;
        for (unsigned int check = 0; check <= n_checks; ++check) {
          const double t = *from + (*std::next(from) - *from) * check / n_checks;
          for (const auto &[constraint, position] : moving) // throws if it is not finite
            constraint->value->value(t, position);
          for (std::size_t i = 0; i < dependent.size(); ++i)
            if (const double difference = std::abs(dependent[i].sum_at(t) - sums_at_start[i]);
                difference > disagreement * discretization.radius())
              dependent[i].refuse(t, difference);
        }
      });
    });
  }
}

Constraints Supports::build(std::vector<double> values) const {
  return build_constraints(discretization_.owned_dofs(), discretization_.relevant_dofs(),
                           {{links_, {}}, {lines_, std::move(values)}});
}

Constraints Supports::at_time(const double t) const {
  fail_together(discretization_.communicator(), [&] {
    for (const auto &redundancy : redundancies_) {
      double sum = redundancy.start;
      for (const auto &term : redundancy.terms)
        sum += term.weight * term.constraint->value->value(t, redundancy.position);
      if (std::abs(sum) > disagreement * discretization_.radius())
        throw SolutionFailure(describe_contradiction(*redundancy.terms.front().constraint, t,
                                                     redundancy.position, redundancy.constraints,
                                                     std::abs(sum)));
    }
  });
  std::vector<double> values;
  fail_together(discretization_.communicator(), [&] {
    for (const auto &prescription : prescriptions_)
      values.push_back(prescription.value(t));
  });
  return build(std::move(values));
}

Constraints Supports::change(const double t_n, const double t, bool &moves) const {
  const auto n_moving =
      std::count_if(prescriptions_.begin(), prescriptions_.end(),
                    [](const Prescription &prescription) { return !prescription.terms.empty(); });
  Usage::count_if(n_moving > 0, Capability::moving_supports, static_cast<std::size_t>(n_moving));
  // One time after the other: an expression is parsed again when the time changes.
  std::vector<double> values;
  fail_together(discretization_.communicator(), [&] {
    for (const auto &prescription : prescriptions_)
      values.push_back(-prescription.value(t_n));
    for (std::size_t i = 0; i < prescriptions_.size(); ++i)
      values[i] += prescriptions_[i].value(t);
  });
  const bool moves_here =
      std::any_of(values.begin(), values.end(), [](const double value) { return value != 0.; });
  moves = dealii::Utilities::MPI::max(moves_here ? 1 : 0, discretization_.communicator()) == 1;
  return build(std::move(values));
}

double Supports::Prescription::value(const double t) const {
  double value = start; // 0 unless supports began within the run
  for (const auto &term : terms)
    value += term.weight * term.constraint->value->value(t, position);
  return value;
}

std::array<double, 3> SupportTrack::at(const double t) const {
  std::array<double, 3> result{};
  for (const Part &part : parts_)
    result[part.line] += part.weight * part.constraint->value->value(t, position_);
  return result;
}

std::vector<SupportTrack> Supports::moving_nodes() const {
  std::vector<SupportTrack> all;
  unsigned int n_lines = 0;
  for (const Prescription &prescription : prescriptions_) {
    const bool continues = !all.empty() && all.back().position_ == prescription.position && n_lines < 3;
    if (!continues) {
      all.emplace_back();
      all.back().position_ = prescription.position;
      n_lines = 0;
    }
    for (const Term &term : prescription.terms)
      if (term.constraint->value)
        all.back().parts_.push_back({term.constraint, term.weight, n_lines});
    ++n_lines;
  }
  // Supports that begin later, each by itself: which of them a node's motion will follow is not
  // known yet.
  const auto begins_later = [](const Constraint &constraint) {
    return constraint.value != nullptr && !constraint.times.acts_after(0.);
  };
  if (acting_.may_change())
    for (const auto &entry : collect_constrained_nodes(scene_, discretization_, begins_later)) {
      all.emplace_back();
      all.back().position_ = entry.second.position;
      const std::vector<const Constraint *> &constraints = entry.second.constraints;
      for (unsigned int i = 0; i < std::min<std::size_t>(constraints.size(), 3); ++i)
        all.back().parts_.push_back({constraints[i], 1., i});
    }
  all.erase(std::remove_if(all.begin(), all.end(),
                           [](const SupportTrack &motion) { return motion.parts_.empty(); }),
            all.end());
  constexpr std::size_t enough = 8;
  const std::size_t stride = all.size() / enough + 1;
  std::vector<SupportTrack> some;
  for (std::size_t i = 0; i < all.size(); i += stride)
    some.push_back(all[i]);
  return some;
}

void Supports::condense(Vector &forces) const { billet::condense(homogeneous_, couples_ranks_, forces); }

} // namespace billet
