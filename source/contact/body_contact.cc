// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_contact.h"

#include "billet/contact/facet_contact.h"
#include "billet/contact/facet_paths.h"
#include "billet/contact/overlap.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/errors.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

/// The same on any number of ranks, and no other facet's: those of two opposite corners.
std::uint64_t make_key(const BoundaryFacet &facet, const NodeKeys &keys) {
  const std::uint64_t first = keys(facet.dofs[0][0]), second = keys(facet.dofs[3][0]);
  return (std::min(first, second) << 32U) | std::max(first, second);
}

FacetMethod method_of(const parameters::ContactPair::Facets facets) {
  using Facets = parameters::ContactPair::Facets;
  switch (facets) {
  case Facets::planed:
    return FacetMethod::planed;
  case Facets::mean_gap:
    return FacetMethod::mean_gap;
  case Facets::bilinear:
    return FacetMethod::bilinear;
  case Facets::automatic: // resolved by the scene
  case Facets::overlap:
    break;
  }
  return FacetMethod::overlap;
}

} // namespace

template <class DisplacementOf> void BodyContact::update_at(const DisplacementOf &displacement_of) {
  for (std::size_t i = 0; i < local_nodes_.size(); ++i)
    positions_[i] = get_vector(nodes_.positions().data(), local_nodes_[i]) + displacement_of(i);
  if (positions_n_.size() != positions_.size())
    positions_n_ = positions_;
  forces_.assign(local_nodes_.size(), Tensor<1, 3>());
  contact_->add_forces(positions_n_, positions_, duration_, forces_);
}

BodyContact::BodyContact(const Scene &scene, const std::size_t pair, const LocalNodes &nodes,
                         const ContactTangent tangent)
    : ContactInterface(scene, scene.body_pairs()[pair]), pair_(scene.body_pairs()[pair]), nodes_(nodes),
      tangent_(tangent) {
  const NodeKeys node_keys(nodes.discretization());
  collect(node_keys);
  const MPI_Comm communicator = nodes.discretization().communicator();
  FacetContactSettings settings;
  settings.method = method_of(pair_.facets);
  settings.friction = pair_.friction;
  settings.two_pass = pair_.two_passes || pair_.is_self_contact;
  settings.edges = pair_.edges;
  if (pair_.is_self_contact)
    settings.partners = FacetSearch::Partners::other_surfaces_and_self;
  double smallest = std::numeric_limits<double>::infinity();
  for (const double area : areas_)
    smallest = std::min(smallest, std::sqrt(area));
  settings.search_margin = std::max(pair_.search_margin * dealii::Utilities::MPI::min(smallest, communicator),
                                    2. * pair_.overlap.closed_gap);
  for (const unsigned int node : local_nodes_)
    keys_.push_back(node_keys(nodes.dofs(node)[0]));
  settings.limits.zone = pair_.smoothing;
  constexpr unsigned int most_changes = 8;
  if (!scene.parameters().is_explicit())
    settings.most_changes = most_changes;
  if (!scene.parameters().is_dynamic())
    settings.touching_gap = touching_gap;
  const auto stiffness = compute_stiffness(scene);
  settings.touching_gap *= std::min(1., max_stiffening_);
  contact_ = std::make_unique<FacetContact>(communicator, settings, keys_, facets_, stiffness, sizes_);
  if (!scene.parameters().is_explicit())
    paths_ = std::make_unique<FacetPaths>(communicator, settings.partners, keys_, facets_, depths_);
}

BodyContact::~BodyContact() = default;

void BodyContact::set_friction_account(const double start_weight, const bool is_static) {
  contact_->set_friction_account(start_weight, is_static);
}
StepWorks BodyContact::compute_step_works(const double weight) const {
  return contact_->works().compute_step_works(weight);
}
bool BodyContact::has_new_couplings() const { return contact_->couplings().has_new(); }
void BodyContact::add_crossings(Crossings &crossings) const { contact_->bounds().add_crossings(crossings); }

void BodyContact::restart() { contact_->restart(); }
void BodyContact::augment() { contact_->augment(); }
void BodyContact::take_back_augmentation() { contact_->take_back_augmentation(); }
void BodyContact::scale_penalties(const double normal, const double tangential) {
  contact_->scale_penalties(normal, tangential);
}
void BodyContact::stiffen_under_load(const double normal, const double tangential) {
  contact_->stiffen_under_load(normal, tangential);
}
double BodyContact::stiffening() const { return contact_->stiffening(); }
double BodyContact::tangential_stiffening() const { return contact_->tangential_stiffening(); }

ContactSprings BodyContact::compute_springs() const { return contact_->measures().compute_springs(); }
double BodyContact::largest_spring() const { return contact_->measures().largest_spring(); }
Penetration BodyContact::penetration() const { return contact_->measures().penetration(); }
double BodyContact::excessive_penetration() const { return contact_->measures().excessive_penetration(); }
double BodyContact::closing_of_new_contacts() const { return contact_->measures().closing_of_new_contacts(); }
double BodyContact::augmentation_gap() const { return contact_->measures().augmentation_error(); }
std::vector<SlaveForce> BodyContact::slave_forces() const { return contact_->measures().slave_forces(); }
std::size_t BodyContact::history_size() const { return contact_->history_size(); }

void BodyContact::collect(const NodeKeys &keys) {
  const Discretization &discretization = nodes_.discretization();
  std::map<DofIndex, unsigned int> index;
  const unsigned int n_surfaces = pair_.is_self_contact ? 1 : 2;
  std::vector<BoundaryFacet> all;
  for (unsigned int surface = 0; surface < n_surfaces; ++surface)
    for (const auto &boundary :
         collect_boundary_facets(discretization, pair_.bodies[surface], pair_.boundary_ids[surface])) {
      all.push_back(boundary);
      SurfaceFacet facet{};
      facet.surface = surface;
      facet.key = make_key(boundary, keys);
      areas_.push_back(boundary.area_vector().norm());
      facet.reach = std::max(contact_reach(boundary), 1.1 * pair_.overlap.closed_gap);
      facet.bulge = bulge_of(boundary, pair_.correction);
      facet.wall = boundary.thickness;
      constexpr double part_of_facet = 0.4; // all methods find nodes there, and no element is as thin
      depths_.push_back(part_of_facet * std::min(std::sqrt(areas_.back()), boundary.thickness));
      for (unsigned int a = 0; a < 4; ++a) {
        const auto [entry, is_new] =
            index.emplace(boundary.dofs[a][0], static_cast<unsigned int>(local_nodes_.size()));
        if (is_new) {
          local_nodes_.push_back(nodes_.find(boundary.dofs[a][0]));
          surface_of_.push_back(surface);
        }
        facet.nodes[a] = entry->second;
      }
      facets_.push_back(facet);
    }
  positions_.resize(local_nodes_.size());
  const auto sizes = compute_facet_sizes(discretization, all);
  for (const unsigned int node : local_nodes_) {
    const FacetSize size = sizes.at(nodes_.dofs(node)[0]);
    sizes_.push_back(size.size);
    penalty_lengths_.push_back(penalty_length(pair_.penalty_counts_thickness, size.size, size.thickness));
  }
}

std::vector<ContactStiffness> BodyContact::compute_stiffness(const Scene &scene) {
  const MPI_Comm communicator = nodes_.discretization().communicator();
  std::array<double, 6> totals{}; // area, number of facets and volume below them, by surface
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    totals[facets_[f].surface] += areas_[f];
    totals[2 + facets_[f].surface] += 1.;
    totals[4 + facets_[f].surface] += areas_[f] * facets_[f].wall;
  }
  MPI_Allreduce(MPI_IN_PLACE, totals.data(), 6, MPI_DOUBLE, MPI_SUM, communicator);
  const auto young = [&](const unsigned int surface) {
    return scene.bodies()[pair_.bodies[surface]].young_modulus;
  };
  const auto mean_length = [&](const unsigned int surface) {
    return penalty_length(pair_.penalty_counts_thickness, std::sqrt(totals[surface] / totals[2 + surface]),
                          totals[4 + surface] / totals[surface]);
  };
  // Overlapping facets pass a uniform pressure exactly if all nodes have the same penalty.
  const bool is_uniform = pair_.facets == parameters::ContactPair::Facets::overlap;
  std::vector<ContactStiffness> stiffness;
  for (std::size_t i = 0; i < local_nodes_.size(); ++i) {
    const unsigned int other = pair_.is_self_contact ? 0 : 1 - surface_of_[i];
    const double own_side =
        young(surface_of_[i]) / (is_uniform ? mean_length(surface_of_[i]) : penalty_lengths_[i]);
    const double other_side = young(other) / mean_length(other);
    const double of_factor = pair_.penalty_of == parameters::ContactPair::PenaltyOf::stiffer
                                 ? std::max(own_side, other_side)
                                 : own_side * other_side / (own_side + other_side);
    const double unit = pair_.penalty_is_factor ? of_factor : 1.;
    stiffness.push_back({unit * pair_.normal_penalty, unit * pair_.tangential_penalty});
    const double enough = enough_penalty * of_factor / unit;
    max_stiffening_ = std::min(max_stiffening_, enough / pair_.normal_penalty);
    if (pair_.has_friction())
      max_tangential_stiffening_ = std::min(max_tangential_stiffening_, enough / pair_.tangential_penalty);
  }
  return stiffness;
}

void BodyContact::update(const NodalVectors &displacements) {
  update_at([&](const std::size_t i) { return get_vector(displacements.data(), local_nodes_[i]); });
}

ContactLoad BodyContact::add_forces(NodalVectors &forces, NodalVectors &bounds) {
  row_sums_.assign(local_nodes_.size(), 0.);
  contact_->bounds().add_row_sums(row_sums_);
  for (std::size_t i = 0; i < local_nodes_.size(); ++i) {
    add_vector(forces.data(), local_nodes_[i], forces_[i]);
    bounds[std::size_t{nodal_stride} * local_nodes_[i]] += row_sums_[i];
  }
  ContactLoad load;
  load.dissipation = contact_->works().local_dissipation();
  return load;
}

void BodyContact::update(const Vector &displacements) {
  update_at([&](const std::size_t i) {
    Tensor<1, 3> displacement;
    for (unsigned int c = 0; c < 3; ++c)
      displacement[c] = displacements(nodes_.dofs(local_nodes_[i])[c]);
    return displacement;
  });
}

void BodyContact::add_forces(Vector &residual) const {
  for (std::size_t i = 0; i < local_nodes_.size(); ++i) {
    const std::array<double, 3> values{-forces_[i][0], -forces_[i][1], -forces_[i][2]};
    residual.add(3, nodes_.dofs(local_nodes_[i]).data(), values.data());
  }
}

std::vector<std::array<DofIndex, 3>> BodyContact::find_all_dofs() const {
  std::vector<std::array<DofIndex, 3>> dofs;
  for (const unsigned int node : local_nodes_)
    dofs.push_back(nodes_.dofs(node));
  contact_->exchange().update(dofs);
  return dofs;
}

void BodyContact::find_couplings() {
  const auto all_dofs = find_all_dofs();
  couplings_.clear();
  contact_->couplings().find(tangent_, [&](const std::vector<unsigned int> &nodes) {
    couplings_.emplace_back();
    std::vector<DofIndex> &dofs = couplings_.back();
    for (const unsigned int node : nodes)
      dofs.insert(dofs.end(), all_dofs[node].begin(), all_dofs[node].end());
    std::sort(dofs.begin(), dofs.end());
  });
}

void BodyContact::add_foreign_dofs(dealii::IndexSet &dofs) const {
  for (const auto &coupled : couplings_)
    dofs.add_indices(coupled.begin(), coupled.end());
}

void BodyContact::add_couplings(dealii::TrilinosWrappers::SparsityPattern &pattern) const {
  for (const auto &dofs : couplings_)
    for (const DofIndex row : dofs)
      pattern.add_entries(row, dofs.begin(), dofs.end(), true);
}

namespace {

/// The constraints of a node's dofs, which name no other nodes' dofs: u = free u + value.
struct NodeConstraint {
  std::array<std::array<double, 3>, 3> free{{{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}}};
  std::array<double, 3> value{};
};

NodeConstraint constraint_of(const Constraints &constraints, const std::array<DofIndex, 3> &dofs) {
  NodeConstraint result;
  for (unsigned int i = 0; i < 3; ++i) {
    if (!constraints.is_constrained(dofs[i]))
      continue;
    result.free[i] = {};
    if (const auto *entries = constraints.get_constraint_entries(dofs[i]))
      for (const auto &[other, factor] : *entries)
        result.free[i][std::find(dofs.begin(), dofs.end(), other) - dofs.begin()] = factor;
    result.value[i] = constraints.get_inhomogeneity(dofs[i]);
  }
  return result;
}

} // namespace

void BodyContact::add_tangent(const TangentSystem &system) const {
  // Of nodes of other ranks, constraints are known there.
  std::vector<NodeConstraint> constraints;
  for (const unsigned int node : local_nodes_)
    constraints.push_back(constraint_of(system.constraints, nodes_.dofs(node)));
  contact_->exchange().update(constraints);
  const auto all_dofs = find_all_dofs(); // ghosts may have changed places since the couplings were found
  FacetSearch::Positions lift(all_dofs.size());
  dealii::FullMatrix<double> half, condensed;
  std::vector<DofIndex> dofs;
  contact_->tangents().visit(
      tangent_, [&](const std::vector<unsigned int> &nodes, const dealii::FullMatrix<double> &K) {
        const std::size_t n = K.m();
        dofs.clear();
        half.reinit(n, n);
        condensed.reinit(n, n);
        for (std::size_t b = 0; b < nodes.size(); ++b) {
          const NodeConstraint &constraint = constraints[nodes[b]];
          dofs.insert(dofs.end(), all_dofs[nodes[b]].begin(), all_dofs[nodes[b]].end());
          for (std::size_t row = 0; row < n; ++row)
            for (unsigned int j = 0; j < 3; ++j)
              for (unsigned int k = 0; k < 3; ++k)
                half(row, 3 * b + j) += K(row, 3 * b + k) * constraint.free[k][j];
        }
        for (std::size_t a = 0; a < nodes.size(); ++a) {
          const NodeConstraint &constraint = constraints[nodes[a]];
          Tensor<1, 3> force;
          for (unsigned int k = 0; k < 3; ++k) {
            for (unsigned int i = 0; i < 3; ++i)
              for (std::size_t column = 0; column < n; ++column)
                condensed(3 * a + i, column) += constraint.free[k][i] * half(3 * a + k, column);
            for (std::size_t b = 0; b < nodes.size(); ++b)
              for (unsigned int j = 0; j < 3; ++j)
                force[k] -= K(3 * a + k, 3 * b + j) * constraints[nodes[b]].value[j];
          }
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int k = 0; k < 3; ++k)
              lift[nodes[a]][i] += constraint.free[k][i] * force[k];
        }
        condensed *= system.weight;
        system.matrix.add(dofs, condensed, false);
      });
  if (system.lift == nullptr)
    return;
  contact_->exchange().collect(lift);
  for (auto &force : lift)
    force *= system.weight;
  for (std::size_t i = 0; i < local_nodes_.size(); ++i)
    system.lift->add(3, nodes_.dofs(local_nodes_[i]).data(), lift[i].begin_raw());
}

FacetSearch::Positions BodyContact::positions_at(const NodalVectors &displacements) const {
  FacetSearch::Positions positions(local_nodes_.size());
  for (std::size_t i = 0; i < local_nodes_.size(); ++i)
    positions[i] = get_vector(nodes_.positions().data(), local_nodes_[i]) +
                   get_vector(displacements.data(), local_nodes_[i]);
  return positions;
}

void BodyContact::save(StateWriter &writer, const NodeKeys & /*keys*/) const {
  contact_->save(writer);
  std::vector<double> rows;
  for (const auto &position : positions_n_)
    RowWriter(rows).vector(position);
  writer.write_rows("positions", 3, keys_, rows);
}

void BodyContact::load(const StateReader &reader, const NodeKeys & /*keys*/) {
  contact_->load(reader);
  const std::vector<double> rows = reader.read_rows("positions", 3, keys_);
  positions_n_.resize(keys_.size());
  for (std::size_t i = 0; i < keys_.size(); ++i)
    RowReader(&rows[3 * i]).vector(positions_n_[i]);
}

void BodyContact::begin(const ContactStep & /*step*/, const NodalVectors &displacements) {
  positions_n_ = positions_at(displacements);
}

FacetSearch::Positions BodyContact::positions_at(const Vector &displacements) const {
  FacetSearch::Positions positions(local_nodes_.size());
  for (std::size_t i = 0; i < local_nodes_.size(); ++i) {
    positions[i] = get_vector(nodes_.positions().data(), local_nodes_[i]);
    for (unsigned int c = 0; c < 3; ++c)
      positions[i][c] += displacements(nodes_.dofs(local_nodes_[i])[c]);
  }
  return positions;
}

void BodyContact::begin(const ContactStep & /*step*/, const Vector &displacements) {
  positions_n_ = positions_at(displacements);
  update(displacements);
  allow_overlap();
}

double BodyContact::find_free_part(const ContactPath &path) const {
  return paths_ ? paths_->find_free_part(positions_at(path.from), positions_at(path.to), path.is_thorough)
                : 1.;
}

std::string BodyContact::describe_obstacle() const {
  return "nodes of contact pair '" + pair_.name + "' would go through the other body";
}

std::vector<double> BodyContact::first_dofs() const {
  std::vector<double> dofs;
  for (const unsigned int node : local_nodes_)
    dofs.push_back(static_cast<double>(nodes_.dofs(node)[0]));
  return dofs;
}

std::vector<double> BodyContact::describe_couplings() const {
  return {static_cast<double>(tangent_), static_cast<double>(pair_.facets), pair_.two_passes ? 1. : 0.};
}

void BodyContact::save_couplings(StateWriter &writer) const {
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(nodes_.discretization().communicator());
  std::vector<double> numbers;
  for (const auto &dofs : couplings_) {
    numbers.push_back(static_cast<double>(dofs.size()));
    for (const DofIndex dof : dofs)
      numbers.push_back(static_cast<double>(dof));
  }
  writer.write("couplings of", describe_couplings());
  writer.write_rows("dofs", 1, keys_, first_dofs());
  write_list(writer, "coupled dofs", rank, numbers);
  write_list(writer, "coupled facets", rank, contact_->couplings().numbers());
}

bool BodyContact::load_couplings(const StateReader &reader) {
  const MPI_Comm communicator = nodes_.discretization().communicator();
  if (!reader.has("couplings of") || reader.read("couplings of") != describe_couplings() ||
      reader.n_ranks() != dealii::Utilities::MPI::n_mpi_processes(communicator))
    return false;
  const bool is_same = reader.read_rows("dofs", 1, keys_) == first_dofs();
  if (dealii::Utilities::MPI::min(is_same ? 1 : 0, communicator) == 0)
    return false;
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
  const std::vector<double> numbers = read_list(reader, "coupled dofs", rank);
  couplings_.clear();
  for (std::size_t i = 0; i < numbers.size();) {
    const auto n = static_cast<std::size_t>(numbers[i++]);
    couplings_.emplace_back();
    for (const std::size_t end = i + n; i < end; ++i)
      couplings_.back().push_back(static_cast<DofIndex>(numbers[i]));
  }
  contact_->couplings().set(read_list(reader, "coupled facets", rank));
  return true;
}

void BodyContact::commit() {
  contact_->commit();
  positions_n_ = positions_;
}

ContactLoad BodyContact::compute_load() const {
  const FacetContactLoad all = contact_->works().compute_load();
  ContactLoad load;
  load.force = all.force;
  load.moment = all.moment;
  load.area = all.area;
  load.stored_energy = all.stored_energy;
  load.dissipation = all.dissipation;
  load.damping = all.damping;
  load.deepest = all.deepest;
  return load;
}

void BodyContact::add_resistances(const std::size_t body, std::vector<Resistance> &resistances) const {
  if (pair_.bodies[0] == pair_.bodies[1])
    return;
  contact_->measures().visit_touching([&](const Tensor<1, 3> &position, const Tensor<1, 3> &normal,
                                          const unsigned int of_node, const unsigned int of_facet) {
    for (const unsigned int side : {of_node, of_facet})
      if (pair_.bodies[side] == body)
        add_contact(position, side == of_node ? normal : -normal, false, pair_.has_friction(), resistances);
  });
}

void BodyContact::start_step(const ContactStep &step) {
  duration_ = step.duration;
  contact_->set_allowed_part(pair_.overlap.allowed_part(step.start), pair_.overlap.allowed_part(step.end));
}

void BodyContact::visit_supporting(const VisitSupporting &visit) const {
  if (pair_.bodies[0] == pair_.bodies[1])
    return;
  contact_->measures().visit_supporting(
      [&](const SupportingPoint &point, const unsigned int of, const unsigned int on) {
        visit(point, pair_.bodies[of], pair_.bodies[on]);
      });
}

std::string BodyContact::describe_restless() const {
  const MPI_Comm communicator = nodes_.discretization().communicator();
  std::array<double, 5> mine{}; // how often, where, how many nodes
  for (const auto &node : contact_->measures().find_restless()) {
    mine[4] += 1.;
    if (node.n_changes > mine[0])
      mine = {static_cast<double>(node.n_changes), node.position[0], node.position[1], node.position[2],
              mine[4]};
  }
  std::array<double, 5> worst{};
  double n_nodes = 0.;
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(communicator, mine)) {
    n_nodes += of_rank[4];
    if (of_rank[0] > worst[0])
      worst = of_rank;
  }
  if (n_nodes == 0.)
    return "";
  std::ostringstream text;
  text << "; contact pair '" << pair_.name << "': " << n_nodes
       << (n_nodes == 1. ? " node keeps" : " nodes keep") << " changing facet or status, most often, "
       << worst[0] << " times, the one at (" << worst[1] << ", " << worst[2] << ", " << worst[3] << "): try "
       << (contact_->method() == FacetMethod::overlap
               ? "a softer penalty, with a 'Penetration tolerance' where that is too soft"
               : "smaller steps, a softer penalty, 'Facets = overlap' or a larger 'Smoothing'");
  return text.str();
}

void BodyContact::allow_overlap() {
  if (pair_.overlap.closed_gap > 0.) {
    contact_->close_initial_gaps(positions_, pair_.overlap.closed_gap);
    forces_.assign(local_nodes_.size(), Tensor<1, 3>());
    contact_->add_forces(positions_n_, positions_, 0., forces_);
  }
  if (!pair_.overlap.is_allowed && !(pair_.overlap.closed_gap > 0.))
    return;
  // A node's mean gap over overlapping facets hides what is deeper in some part of them: again, then, until
  // nothing is left. Each time takes a part of it.
  constexpr unsigned int most_times = 200;
  constexpr double none = 1e-10; // facet sizes
  const MPI_Comm communicator = nodes_.discretization().communicator();
  for (unsigned int i = 0; i < most_times; ++i) {
    if (dealii::Utilities::MPI::max(contact_->allow_initial_depths(), communicator) <= none)
      return;
    forces_.assign(local_nodes_.size(), Tensor<1, 3>());
    contact_->add_forces(positions_n_, positions_, 0., forces_);
  }
}

std::vector<ContactNodeReport> BodyContact::report() const {
  std::vector<ContactNodeReport> reports;
  const auto states = contact_->measures().report();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double area = nodes_.is_owned(local_nodes_[i]) ? states[i].area : 0.;
    reports.push_back({nodes_.dofs(local_nodes_[i]), states[i].status, states[i].pressure, states[i].gap,
                       states[i].slip, area, states[i].traction, states[i].penetration, sizes_[i],
                       states[i].tangential_stiffness});
  }
  return reports;
}

} // namespace billet
