// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/contact_set.h"

#include <algorithm>
#include <limits>

namespace billet {

namespace {

struct ContactSetLimits {
  /// Unit of penetration in pairs without a tolerance [facet size]: the tightest tolerance that a
  /// target error sets.
  static constexpr double penetration = 1e-5;
  /// Error of a position in penalties, as multiple of its last bit.
  static constexpr double last_bits = 3.;
  /// Minimum penalty of the pairs that cause most of the round-off, as part of the largest one.
  static constexpr double as_stiff = 0.1;
};

} // namespace

ContactSet::ContactSet(const Scene &scene, const Discretization &discretization)
    : Contacts(scene, discretization, scene.contact_tangent()), communicator_(discretization.communicator()),
      reach_(discretization.centre().norm() + discretization.radius()) {}

void ContactSet::update(const Vector &displacements, Vector &residual) {
  for (auto &contact : *this) {
    contact.with_matrix().update(displacements);
    contact.with_matrix().add_forces(residual);
  }
}

void ContactSet::restart() {
  for (auto &contact : *this)
    contact.restart();
}

void ContactSet::take_back_augmentation() {
  for (auto &contact : *this)
    contact.penalties().take_back_augmentation();
}

std::vector<double> ContactSet::augmentation_errors() const {
  return collect_max([](const auto &contact) { return contact.penalties().augmentation_error(); });
}

double ContactSet::find_penetration() const {
  double of_augmentation = 0.;
  for (const double error : augmentation_errors())
    of_augmentation = std::max(of_augmentation, error);
  return std::max(of_augmentation, max([](const auto &contact) {
                                     return contact.settings().has_tolerance()
                                                ? 0.
                                                : contact.measures().penetration().of_facet;
                                   }) / ContactSetLimits::penetration);
}

double ContactSet::find_spring_round_off() const {
  double force = 0.;
  for (const auto &contact : *this)
    force = std::max(force, contact.penalties().max_spring() * (reach_ + contact.measures().surface_reach()));
  return ContactSetLimits::last_bits * std::numeric_limits<double>::epsilon() *
         dealii::Utilities::MPI::max(force, communicator_);
}

std::vector<double> ContactSet::stiffening_left() const {
  return collect_min([](const auto &contact) { return contact.penalties().stiffening_left(); });
}

std::string ContactSet::stiffest_pairs() const {
  const std::vector<double> springs =
      collect_max([](const auto &contact) { return contact.penalties().max_spring(); });
  const double stiffest = *std::max_element(springs.begin(), springs.end());
  std::string result;
  for (std::size_t i = 0; i < springs.size(); ++i)
    if (springs[i] >= ContactSetLimits::as_stiff * stiffest)
      result += (result.empty() ? "'" : ", '") + (*this)[i].name() + "'";
  return result;
}

std::vector<std::vector<SlaveForce>> ContactSet::slave_forces() const {
  return collect([](const auto &contact) { return contact.measures().slave_forces(); });
}

std::vector<FrictionUse> ContactSet::friction_uses() const {
  std::vector<FrictionUse> uses =
      collect([](const auto &contact) { return contact.measures().friction_use(); });
  std::vector<double> sums;
  for (const FrictionUse &use : uses)
    sums.insert(sums.end(), {use.tangential, use.limit, use.slipping});
  dealii::Utilities::MPI::sum(sums, communicator_, sums);
  for (std::size_t i = 0; i < uses.size(); ++i)
    uses[i] = {sums[3 * i], sums[3 * i + 1], sums[3 * i + 2]};
  return uses;
}

std::vector<double> ContactSet::stored_energies() const {
  return collect([](const auto &contact) { return contact.measures().compute_load().stored_energy; });
}

StepWorks ContactSet::compute_step_works(const double weight) const {
  StepWorks works;
  for (const auto &contact : *this)
    works += contact.measures().compute_step_works(weight);
  return works;
}

ContactLoad ContactSet::compute_load(const std::size_t tool) const {
  ContactLoad load;
  for (const auto &contact : of_tools())
    if (contact.tool() == tool)
      load += contact.measures().compute_load();
  return load;
}

double ContactSet::find_free_part(const ContactPath &path, std::string &obstacle) const {
  if (empty())
    return 1.;
  const std::vector<double> parts =
      collect_min([&](const auto &contact) { return contact.with_matrix().find_free_part(path); });
  const auto minimum = std::min_element(parts.begin(), parts.end());
  if (*minimum < 1.)
    obstacle = (*this)[static_cast<std::size_t>(minimum - parts.begin())].checks().describe_obstacle();
  return *minimum;
}

} // namespace billet
