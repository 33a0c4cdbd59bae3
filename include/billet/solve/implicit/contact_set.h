// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_CONTACT_SET_H
#define BILLET_SOLVE_IMPLICIT_CONTACT_SET_H

#include "billet/contact/body_contact.h"
#include "billet/contact/rigid_contact.h"

#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace billet {

/// All contacts of an implicit scene, those with tools first. Values of each contact stand in this order.
class ContactSet {
public:
  ContactSet(const Scene &scene, const Discretization &discretization);

  std::size_t size() const { return of_tools_.size() + of_bodies_.size(); }
  bool empty() const { return size() == 0; }
  std::vector<RigidContact> &of_tools() { return of_tools_; }
  const std::vector<RigidContact> &of_tools() const { return of_tools_; }
  const std::vector<std::unique_ptr<BodyContact>> &of_bodies() const { return of_bodies_; }
  bool is_of_tool(const std::size_t contact) const { return contact < of_tools_.size(); }

  /// Calls visit(contact) for each contact.
  template <class Visit> void for_each(const Visit &visit) {
    for (auto &contact : of_tools_)
      visit(contact);
    for (auto &contact : of_bodies_)
      visit(*contact);
  }
  template <class Visit> void for_each(const Visit &visit) const {
    for (const auto &contact : of_tools_)
      visit(contact);
    for (const auto &contact : of_bodies_)
      visit(const_cast<const BodyContact &>(*contact));
  }
  /// Calls visit(contact) for one contact, and returns what that returns.
  template <class Visit> auto at(const std::size_t contact, const Visit &visit) {
    return is_of_tool(contact) ? visit(of_tools_[contact]) : visit(*of_bodies_[contact - of_tools_.size()]);
  }
  /// Collects get(contact) of each contact on this rank.
  template <class Get> auto collect(const Get &get) const {
    std::vector<std::decay_t<decltype(get(of_tools_.front()))>> values;
    for_each([&](const auto &contact) { values.push_back(get(contact)); });
    return values;
  }
  /// The same numbers, each the largest or the smallest of all ranks. Collective.
  template <class Get> std::vector<double> collect_max(const Get &get) const {
    std::vector<double> values = collect(get);
    dealii::Utilities::MPI::max(values, communicator_, values);
    return values;
  }
  template <class Get> std::vector<double> collect_min(const Get &get) const {
    std::vector<double> values = collect(get);
    dealii::Utilities::MPI::min(values, communicator_, values);
    return values;
  }
  /// The largest of all contacts and ranks; 0 if all are below. Collective.
  template <class Get> double max(const Get &get) const {
    double largest = 0.;
    for (const double value : collect(get))
      largest = std::max(largest, value);
    return dealii::Utilities::MPI::max(largest, communicator_);
  }
  std::vector<std::string> names() const;

  /// Computes gaps and tractions at `displacements` (ghosted), `duration` after the start of the step.
  /// Collective.
  void update(const Vector &displacements, double duration);
  /// The same, and adds −F_c [force] to `residual` (additive vector), contact by contact. Collective.
  void update(const Vector &displacements, double duration, Vector &residual);
  void restart();
  void take_back_augmentation();

  /// Error of the augmentation of each contact, as part of what its pair asks for. Collective.
  std::vector<double> augmentation_errors() const;
  /// The largest of them, and the penetration in pairs without a tolerance, as part of 1e-5 facets.
  /// Collective.
  double find_penetration() const;
  /// Force that round-off in positions makes of the stiffest penalty. Collective.
  double find_spring_round_off() const;
  /// By how many times penalties may become stiffer until they are 10 E/h. Collective.
  std::vector<double> stiffening_left() const;
  void stiffen(std::size_t contact, double factor);
  /// Names of the pairs whose penalties make most of the round-off. Collective.
  std::string stiffest_pairs() const;
  std::vector<std::vector<SlaveForce>> slave_forces() const;
  /// Energy in the springs of each contact. Collective.
  std::vector<double> stored_energies() const;
  /// Works of all contacts in the step, before commit(); `weight` as in RigidContact. Collective.
  StepWorks compute_step_works(double weight) const;
  /// Load that the contacts of a tool exert. Collective.
  ContactLoad compute_load(std::size_t tool) const;

  /// Part of the motion in which no node goes through anything; `obstacle` says who would. Placements are of
  /// tools. Collective.
  double find_free_part(const Vector &from, const std::vector<Placement> &tools_from, const Vector &to,
                        const std::vector<Placement> &tools_to, bool is_thorough,
                        std::string &obstacle) const;

private:
  const Scene &scene_;
  MPI_Comm communicator_;
  double reach_; ///< largest coordinate of the scene [length]
  std::vector<RigidContact> of_tools_;
  std::unique_ptr<LocalNodes> nodes_; ///< only with contact between bodies
  std::vector<std::unique_ptr<BodyContact>> of_bodies_;
};

} // namespace billet

#endif
