// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/contact_set.h"

#include "billet/contact/overlap.h"

#include <algorithm>
#include <limits>

namespace billet {

ContactSet::ContactSet(const Scene &scene, const Discretization &discretization)
    : scene_(scene), communicator_(discretization.communicator()),
      reach_(discretization.centre().norm() + discretization.radius()) {
  for (std::size_t p = 0; p < scene.pairs().size(); ++p)
    of_tools_.emplace_back(scene, p, discretization, scene.contact_tangent());
  RigidContact::introduce(of_tools_);
  if (!scene.body_pairs().empty())
    nodes_ = std::make_unique<LocalNodes>(discretization);
  for (std::size_t p = 0; p < scene.body_pairs().size(); ++p) {
    of_bodies_.push_back(std::make_unique<BodyContact>(scene, p, *nodes_));
    if (!scene.parameters().restart.is_wanted()) // it begins with deformed bodies
      check_overlap(scene, p, discretization);
  }
}

std::vector<std::string> ContactSet::names() const {
  return collect([](const auto &contact) { return contact.name(); });
}

namespace {

void update_one(RigidContact &contact, const Vector &displacements, double) { contact.update(displacements); }
void update_one(BodyContact &contact, const Vector &displacements, const double duration) {
  contact.update(displacements, duration);
}

} // namespace

void ContactSet::update(const Vector &displacements, const double duration) {
  for_each([&](auto &contact) { update_one(contact, displacements, duration); });
}

void ContactSet::update(const Vector &displacements, const double duration, Vector &residual) {
  for_each([&](auto &contact) {
    update_one(contact, displacements, duration);
    contact.add_forces(residual);
  });
}

void ContactSet::restart() {
  for_each([](auto &contact) { contact.restart(); });
}

void ContactSet::take_back_augmentation() {
  for_each([](auto &contact) { contact.take_back_augmentation(); });
}

std::vector<double> ContactSet::augmentation_errors() const {
  return collect_max([](const auto &contact) { return contact.augmentation_error(); });
}

double ContactSet::find_penetration() const {
  constexpr double unit = 1e-5; // facet sizes: the tightest tolerance that a target error sets
  double of_augmentation = 0.;
  for (const double error : augmentation_errors())
    of_augmentation = std::max(of_augmentation, error);
  return std::max(of_augmentation,
                  max([](const auto &contact) {
                    return contact.settings().has_tolerance() ? 0. : contact.penetration().of_facet;
                  }) / unit);
}

double ContactSet::find_spring_round_off() const {
  constexpr double last_bits = 3.; // times what the last bit of a position makes
  double force = 0.;
  for (const auto &contact : of_tools_)
    force = std::max(force, contact.largest_spring() * (reach_ + contact.tool_reach()));
  for (const auto &contact : of_bodies_)
    force = std::max(force, contact->largest_spring() * reach_);
  return last_bits * std::numeric_limits<double>::epsilon() *
         dealii::Utilities::MPI::max(force, communicator_);
}

std::vector<double> ContactSet::stiffening_left() const {
  return collect_min([](const auto &contact) { return contact.stiffening_left(); });
}

void ContactSet::stiffen(const std::size_t contact, const double factor) {
  at(contact, [&](auto &which) { which.stiffen(factor); });
}

std::string ContactSet::stiffest_pairs() const {
  const std::vector<double> springs =
      collect_max([](const auto &contact) { return contact.largest_spring(); });
  const double stiffest = *std::max_element(springs.begin(), springs.end());
  const std::vector<std::string> of_pairs = names();
  constexpr double as_stiff = 0.1;
  std::string result;
  for (std::size_t i = 0; i < springs.size(); ++i)
    if (springs[i] >= as_stiff * stiffest)
      result += (result.empty() ? "'" : ", '") + of_pairs[i] + "'";
  return result;
}

std::vector<std::vector<SlaveForce>> ContactSet::slave_forces() const {
  return collect([](const auto &contact) { return contact.slave_forces(); });
}

std::vector<double> ContactSet::stored_energies() const {
  return collect([](const auto &contact) { return contact.compute_load().stored_energy; });
}

StepWorks ContactSet::compute_step_works(const double weight) const {
  StepWorks works;
  for_each([&](const auto &contact) { works += contact.compute_step_works(weight); });
  return works;
}

ContactLoad ContactSet::compute_load(const std::size_t tool) const {
  ContactLoad load;
  for (const auto &contact : of_tools_)
    if (contact.tool() == tool)
      load += contact.compute_load();
  return load;
}

double ContactSet::find_free_part(const Vector &from, const std::vector<Placement> &tools_from,
                                  const Vector &to, const std::vector<Placement> &tools_to,
                                  const bool is_thorough, std::string &obstacle) const {
  std::vector<double> parts;
  for (const auto &contact : of_tools_)
    parts.push_back(
        contact.find_free_part(from, tools_from[contact.tool()], to, tools_to[contact.tool()], is_thorough));
  if (!parts.empty())
    dealii::Utilities::MPI::min(parts, communicator_, parts);
  for (const auto &contact : of_bodies_)
    parts.push_back(contact->find_free_part(from, to, is_thorough));
  const auto least = std::min_element(parts.begin(), parts.end());
  if (least == parts.end() || *least == 1.)
    return 1.;
  const auto which = static_cast<std::size_t>(least - parts.begin());
  obstacle = "nodes of contact pair '" + names()[which] + "' would go through " +
             (is_of_tool(which) ? "tool '" + scene_.tools()[of_tools_[which].tool()].name() + "'"
                                : "the other body");
  return *least;
}

} // namespace billet
