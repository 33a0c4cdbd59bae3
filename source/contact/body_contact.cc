// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_contact.h"

#include "billet/contact/contact_blocks.h"
#include "billet/contact/facet_contact.h"
#include "billet/contact/facet_paths.h"
#include "billet/contact/overlap.h"
#include "billet/errors.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

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

BodyContact::BodyContact(const Scene &scene, const std::size_t pair, const LocalNodes &nodes,
                         const ContactTangent tangent)
    : ContactInterface(scene, scene.body_pairs()[pair]), pair_(scene.body_pairs()[pair]), nodes_(nodes),
      surfaces_(pair_, nodes, NodeKeys(nodes.discretization())), positions_(surfaces_.local_nodes.size()),
      tangent_(tangent) {
  const MPI_Comm communicator = nodes.discretization().communicator();
  FacetContactSettings settings;
  settings.method = method_of(pair_.facets);
  settings.friction = pair_.friction;
  settings.two_pass = pair_.two_passes || pair_.is_self_contact;
  settings.edges = pair_.edges;
  if (pair_.is_self_contact)
    settings.partners = FacetSearch::Partners::other_surfaces_and_self;
  settings.search_margin = std::max(pair_.search_margin * surfaces_.find_smallest_size(communicator),
                                    2. * pair_.overlap.closed_gap);
  settings.limits.zone = pair_.smoothing;
  constexpr unsigned int most_changes = 8;
  if (!scene.parameters().is_explicit())
    settings.most_changes = most_changes;
  if (!scene.parameters().is_dynamic())
    settings.touching_gap = touching_gap;
  const PairPenalties penalties = compute_penalties(scene, pair_, surfaces_, communicator);
  max_stiffening_ = penalties.max_stiffening;
  max_tangential_stiffening_ = penalties.max_tangential_stiffening;
  settings.touching_gap *= std::min(1., max_stiffening_);
  contact_ = std::make_unique<FacetContact>(communicator, settings, surfaces_.keys, surfaces_.facets,
                                            penalties.of_nodes, surfaces_.sizes);
  blocks_ = std::make_unique<ContactBlocks>(*contact_, nodes, surfaces_.local_nodes);
  if (!scene.parameters().is_explicit())
    paths_ = std::make_unique<FacetPaths>(communicator, settings.partners, surfaces_.keys, surfaces_.facets,
                                          surfaces_.depths);
}

BodyContact::~BodyContact() = default;

void BodyContact::set_friction_account(const double start_weight, const bool is_static) {
  contact_->set_friction_account(start_weight, is_static);
}
StepWorks BodyContact::compute_step_works(const double weight) const {
  return contact_->works().compute_step_works(weight);
}

void BodyContact::add_tangent(const TangentSystem &system) const { blocks_->add_tangent(tangent_, system); }
bool BodyContact::has_new_couplings() const { return blocks_->has_new(); }
void BodyContact::find_couplings() { blocks_->find(tangent_); }
void BodyContact::add_foreign_dofs(dealii::IndexSet &dofs) const { blocks_->add_foreign_dofs(dofs); }
void BodyContact::add_couplings(SparsityPattern &pattern) const { blocks_->add_entries(pattern); }
void BodyContact::save_couplings(StateWriter &writer) const {
  blocks_->save(writer, surfaces_.keys, describe_couplings());
}
bool BodyContact::load_couplings(const StateReader &reader) {
  return blocks_->load(reader, surfaces_.keys, describe_couplings());
}

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

void BodyContact::place(const NodalVectors &displacements, FacetSearch::Positions &positions) const {
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = get_vector(nodes_.positions().data(), surfaces_.local_nodes[i]) +
                   get_vector(displacements.data(), surfaces_.local_nodes[i]);
}

void BodyContact::place(const Vector &displacements, FacetSearch::Positions &positions) const {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] = get_vector(nodes_.positions().data(), surfaces_.local_nodes[i]);
    for (unsigned int c = 0; c < 3; ++c)
      positions[i][c] += displacements(nodes_.dofs(surfaces_.local_nodes[i])[c]);
  }
}

void BodyContact::evaluate(const double duration) {
  if (positions_n_.size() != positions_.size())
    positions_n_ = positions_;
  forces_.assign(positions_.size(), Tensor<1, 3>());
  contact_->add_forces(positions_n_, positions_, duration, forces_);
}

void BodyContact::update(const NodalVectors &displacements) {
  place(displacements, positions_);
  evaluate(duration_);
}

ContactLoad BodyContact::add_forces(NodalVectors &forces, NodalVectors &bounds) {
  row_sums_.assign(surfaces_.local_nodes.size(), 0.);
  contact_->bounds().add_row_sums(row_sums_);
  for (std::size_t i = 0; i < surfaces_.local_nodes.size(); ++i) {
    add_vector(forces.data(), surfaces_.local_nodes[i], forces_[i]);
    bounds[std::size_t{nodal_stride} * surfaces_.local_nodes[i]] += row_sums_[i];
  }
  ContactLoad load;
  load.dissipation = contact_->works().local_dissipation();
  return load;
}

void BodyContact::update(const Vector &displacements) {
  place(displacements, positions_);
  evaluate(duration_);
}

void BodyContact::add_forces(Vector &residual) const {
  for (std::size_t i = 0; i < surfaces_.local_nodes.size(); ++i) {
    const std::array<double, 3> values{-forces_[i][0], -forces_[i][1], -forces_[i][2]};
    residual.add(3, nodes_.dofs(surfaces_.local_nodes[i]).data(), values.data());
  }
}

void BodyContact::save(StateWriter &writer, const NodeKeys & /*keys*/) const {
  contact_->save(writer);
  std::vector<double> rows;
  for (const auto &position : positions_n_)
    RowWriter(rows).vector(position);
  writer.write_rows("positions", 3, surfaces_.keys, rows);
}

void BodyContact::load(const StateReader &reader, const NodeKeys & /*keys*/) {
  contact_->load(reader);
  const std::vector<double> rows = reader.read_rows("positions", 3, surfaces_.keys);
  positions_n_.resize(surfaces_.keys.size());
  for (std::size_t i = 0; i < surfaces_.keys.size(); ++i)
    RowReader(&rows[3 * i]).vector(positions_n_[i]);
}

void BodyContact::begin(const ContactStep & /*step*/, const NodalVectors &displacements) {
  positions_n_.resize(positions_.size());
  place(displacements, positions_n_);
}

void BodyContact::begin(const ContactStep & /*step*/, const Vector &displacements) {
  positions_n_.resize(positions_.size());
  place(displacements, positions_n_);
  update(displacements);
  allow_overlap();
}

double BodyContact::find_free_part(const ContactPath &path) const {
  if (!paths_)
    return 1.;
  FacetSearch::Positions from(positions_.size()), to(positions_.size());
  place(path.from, from);
  place(path.to, to);
  return paths_->find_free_part(from, to, path.is_thorough);
}

std::string BodyContact::describe_obstacle() const {
  return "nodes of contact pair '" + pair_.name + "' would go through the other body";
}

std::vector<double> BodyContact::describe_couplings() const {
  return {static_cast<double>(tangent_), static_cast<double>(pair_.facets), pair_.two_passes ? 1. : 0.};
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
  std::array<double, 5> mine{}; // number of changes, position, number of nodes
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
    evaluate(0.);
  }
  if (!pair_.overlap.is_allowed && !(pair_.overlap.closed_gap > 0.))
    return;
  // A node's mean gap over overlapping facets hides larger penetrations in parts of them. Repetition reduces
  // these until none remain.
  constexpr unsigned int most_times = 200;
  constexpr double none = 1e-10; // facet sizes
  const MPI_Comm communicator = nodes_.discretization().communicator();
  for (unsigned int i = 0; i < most_times; ++i) {
    if (dealii::Utilities::MPI::max(contact_->allow_initial_depths(), communicator) <= none)
      return;
    evaluate(0.);
  }
}

std::vector<ContactNodeReport> BodyContact::report() const {
  std::vector<ContactNodeReport> reports;
  const auto states = contact_->measures().report();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double area = nodes_.is_owned(surfaces_.local_nodes[i]) ? states[i].area : 0.;
    reports.push_back({nodes_.dofs(surfaces_.local_nodes[i]), states[i].status, states[i].pressure,
                       states[i].gap, states[i].slip, area, states[i].traction, states[i].penetration,
                       surfaces_.sizes[i], states[i].tangential_stiffness});
  }
  return reports;
}

} // namespace billet
