// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_contact.h"

#include "billet/contact/body_checks.h"
#include "billet/contact/body_couplings.h"
#include "billet/contact/body_measures.h"
#include "billet/contact/facet_contact.h"
#include "billet/contact/facet_paths.h"
#include "billet/contact/overlap.h"
#include "billet/errors.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

BodyContact::BodyContact(const Scene &scene, const std::size_t pair, const LocalNodes &nodes,
                         const ContactTangent tangent)
    : ContactInterface(scene, scene.body_pairs()[pair]), pair_(scene.body_pairs()[pair]), nodes_(nodes),
      surfaces_(pair_, nodes, NodeKeys(nodes.discretization())), positions_(surfaces_.local_nodes.size()) {
  const MPI_Comm communicator = nodes.discretization().communicator();
  FacetContactSettings settings;
  settings.method = pair_.facets;
  settings.friction = pair_.friction;
  settings.two_pass = pair_.two_passes || pair_.is_self_contact;
  settings.edges = pair_.edges;
  if (pair_.is_self_contact)
    settings.partners = FacetSearch::Partners::other_surfaces_and_self;
  settings.search_margin = std::max(pair_.search_margin * surfaces_.find_smallest_size(communicator),
                                    2. * pair_.overlap.closed_gap);
  settings.limits.zone = pair_.smoothing;
  if (!scene.parameters().is_explicit())
    settings.max_changes = RestlessNodes::max_changes;
  if (!scene.parameters().is_dynamic())
    settings.touching_gap = touching_gap;
  const PairPenalties penalties = compute_penalties(scene, pair_, surfaces_, communicator);
  settings.penetration_tolerance = pair_.penetration_tolerance.value_or(0.);
  settings.max_stiffening = penalties.max_stiffening;
  settings.touching_gap *= std::min(1., settings.max_stiffening.normal);
  contact_ = std::make_unique<FacetContact>(communicator, settings, surfaces_.keys, surfaces_.facets,
                                            penalties.of_nodes, surfaces_.sizes);
  couplings_ = std::make_unique<BodyCouplings>(pair_, nodes, surfaces_, *contact_, tangent);
  measures_ = std::make_unique<BodyMeasures>(pair_, nodes, surfaces_, *contact_);
  checks_ = std::make_unique<BodyChecks>(pair_, *contact_, communicator);
  if (!scene.parameters().is_explicit())
    paths_ = std::make_unique<FacetPaths>(communicator, settings.partners, surfaces_.keys, surfaces_.facets,
                                          surfaces_.penetrations);
}

BodyContact::~BodyContact() = default;

ContactPenalties &BodyContact::penalties() { return contact_->penalties(); }
const ContactPenalties &BodyContact::penalties() const { return contact_->penalties(); }
const ContactMeasures &BodyContact::measures() const { return *measures_; }
ContactCouplings &BodyContact::couplings() { return *couplings_; }
const ContactCouplings &BodyContact::couplings() const { return *couplings_; }
const ContactChecks &BodyContact::checks() const { return *checks_; }

void BodyContact::set_friction_account(const double start_weight, const bool is_static) {
  contact_->set_friction_account(start_weight, is_static);
}
void BodyContact::set_tangent(const ContactTangent tangent) { couplings_->set_tangent(tangent); }
void BodyContact::add_tangent(const TangentSystem &system) const { couplings_->add_tangent(system); }
void BodyContact::add_crossings(Crossings &crossings) const { contact_->bounds().add_crossings(crossings); }
void BodyContact::restart() { contact_->restart(); }

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
    RowReader(&rows[3 * i], 3).vector(positions_n_[i]);
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

void BodyContact::commit() {
  contact_->commit();
  positions_n_ = positions_;
}

void BodyContact::start_step(const ContactStep &step) {
  duration_ = step.duration;
  contact_->set_allowed_part(pair_.overlap.allowed_part(step.start), pair_.overlap.allowed_part(step.end));
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
  constexpr unsigned int max_times = 200;
  constexpr double none = 1e-10; // facet sizes
  const MPI_Comm communicator = nodes_.discretization().communicator();
  for (unsigned int i = 0; i < max_times; ++i) {
    if (dealii::Utilities::MPI::max(contact_->allow_initial_penetrations(), communicator) <= none)
      return;
    evaluate(0.);
  }
}

} // namespace billet
