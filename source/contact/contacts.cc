// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/contacts.h"

#include "billet/contact/overlap.h"

namespace billet {

Contacts::Contacts(const Scene &scene, const Discretization &discretization, const ContactTangent tangent)
    : n_tools_(scene.tools().size()) {
  for (std::size_t p = 0; p < scene.pairs().size(); ++p)
    of_tools_.emplace_back(scene, p, discretization, tangent);
  if (!scene.body_pairs().empty())
    own_nodes_ = std::make_unique<LocalNodes>(discretization);
  for (std::size_t p = 0; p < scene.body_pairs().size(); ++p) {
    of_bodies_.emplace_back(scene, p, *own_nodes_, tangent);
    if (!scene.parameters().restart.is_wanted()) // a restart begins with deformed bodies
      check_overlap(scene, p, discretization);
  }
  list_all();
}

Contacts::~Contacts() = default;

Contacts::Contacts(const Scene &scene, const LocalNodes &nodes) : n_tools_(scene.tools().size()) {
  const Discretization &discretization = nodes.discretization();
  for (std::size_t p = 0; p < scene.pairs().size(); ++p) {
    of_tools_.emplace_back(scene, p, nodes);
  }
  for (std::size_t p = 0; p < scene.body_pairs().size(); ++p) {
    of_bodies_.emplace_back(scene, p, nodes);
    if (!scene.parameters().restart.is_wanted()) // a restart begins with deformed bodies
      check_overlap(scene, p, discretization);
  }
  list_all();
}

void Contacts::list_all() {
  RigidContact::link_neighbours(of_tools_);
  for (auto &contact : of_tools_)
    all_.push_back(&contact);
  for (auto &contact : of_bodies_)
    all_.push_back(&contact);
}

Contacts::Loads Contacts::compute_loads() const {
  Loads loads;
  loads.of_tools.resize(n_tools_);
  for (const ContactInterface &contact : *this)
    if (const auto &tool = contact.rigid_tool())
      loads.of_tools[*tool] += contact.measures().compute_load();
    else
      loads.of_body_pairs.push_back(contact.measures().compute_load());
  return loads;
}

std::size_t Contacts::history_size() const {
  std::size_t size = 0;
  for (const ContactInterface &contact : *this)
    size += contact.measures().history_size();
  return size;
}

std::vector<std::vector<ContactNodeReport>> Contacts::report() const {
  return collect([](const ContactInterface &contact) { return contact.measures().report(); });
}

DiagnosticList Contacts::check_start() const {
  DiagnosticList list;
  for (const ContactInterface &contact : *this)
    append(list, contact.checks().check_start());
  return list;
}

} // namespace billet
