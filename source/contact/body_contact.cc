// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_contact.h"

#include "billet/contact/body_checks.h"
#include "billet/contact/body_explicit_contact.h"
#include "billet/contact/body_matrix_contact.h"
#include "billet/contact/body_measures.h"
#include "billet/contact/facet_contact.h"

namespace billet {

BodyContact::BodyContact(const Scene &scene, const BodyPair &pair, const LocalNodes &nodes)
    : ContactInterface(scene, pair), parts_(scene, pair, nodes),
      measures_(std::make_unique<BodyMeasures>(parts_.pair, nodes, parts_.surfaces, *parts_.contact)),
      checks_(std::make_unique<BodyChecks>(parts_.pair, *parts_.contact, parts_.communicator)) {}

BodyContact::BodyContact(const Scene &scene, const std::size_t pair, const LocalNodes &nodes,
                         const ContactTangent tangent)
    : BodyContact(scene, scene.body_pairs()[pair], nodes) {
  with_matrix_ = std::make_unique<BodyMatrixContact>(parts_, tangent);
}

BodyContact::BodyContact(const Scene &scene, const std::size_t pair, const LocalNodes &nodes)
    : BodyContact(scene, scene.body_pairs()[pair], nodes) {
  without_matrix_ = std::make_unique<BodyExplicitContact>(parts_);
}

BodyContact::~BodyContact() = default;

MatrixContact &BodyContact::with_matrix() { return *with_matrix_; }
const MatrixContact &BodyContact::with_matrix() const { return *with_matrix_; }
ExplicitContact &BodyContact::without_matrix() { return *without_matrix_; }
const ExplicitContact &BodyContact::without_matrix() const { return *without_matrix_; }
ContactPenalties &BodyContact::penalties() { return parts_.contact->penalties(); }
const ContactPenalties &BodyContact::penalties() const { return parts_.contact->penalties(); }
const ContactMeasures &BodyContact::measures() const { return *measures_; }
const ContactChecks &BodyContact::checks() const { return *checks_; }

void BodyContact::start_step(const ContactStep &step) {
  parts_.duration = step.duration;
  parts_.contact->set_allowed_part(parts_.pair.overlap.allowed_part(step.start),
                                   parts_.pair.overlap.allowed_part(step.end));
}

void BodyContact::set_friction_account(const double start_weight, const FrictionAccounting &accounting) {
  parts_.contact->set_friction_account(start_weight, accounting);
}

void BodyContact::restart() { parts_.contact->restart(); }

void BodyContact::commit() {
  parts_.contact->commit();
  parts_.positions_n = parts_.positions;
}

StartGaps BodyContact::start_gaps() const {
  FacetSearch::Positions undeformed;
  for (const unsigned int node : parts_.surfaces.local_nodes)
    undeformed.push_back(get_vector(parts_.nodes.positions().data(), node));
  return parts_.contact->measures().start_gaps(undeformed);
}

void BodyContact::save(StateWriter &writer, const NodeKeys & /*keys*/) const {
  parts_.contact->save(writer);
  std::vector<double> rows;
  for (const auto &position : parts_.positions_n)
    RowWriter(rows).vector(position);
  writer.write_rows("positions", 3, parts_.surfaces.keys, rows);
}

void BodyContact::load(const StateReader &reader, const NodeKeys & /*keys*/) {
  parts_.contact->load(reader);
  const std::vector<std::uint64_t> &keys = parts_.surfaces.keys;
  const std::vector<double> rows = reader.read_rows("positions", 3, keys);
  parts_.positions_n.resize(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    RowReader(&rows[3 * i], 3).vector(parts_.positions_n[i]);
}

} // namespace billet
