// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_CONTACT_SET_H
#define BILLET_SOLVE_IMPLICIT_CONTACT_SET_H

#include "billet/contact/contacts.h"

#include <algorithm>
#include <string>
#include <vector>

namespace billet {

/// All contacts of an implicit scene, with values over all ranks. Values of each contact are in the
/// order of Contacts.
class ContactSet : public Contacts {
public:
  ContactSet(const Scene &scene, const Discretization &discretization);

  /// Collects get(contact) of each contact, the maximum or the minimum over all ranks. Collective.
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
  /// Returns the maximum over all contacts and ranks, at least 0. Collective.
  template <class Get> double max(const Get &get) const {
    double maximum = 0.;
    for (const double value : collect(get))
      maximum = std::max(maximum, value);
    return dealii::Utilities::MPI::max(maximum, communicator_);
  }

  /// Computes gaps and tractions at `displacements` (ghosted), and adds −F_c [force] to `residual`
  /// (additive vector), contact by contact. Collective.
  void update(const Vector &displacements, Vector &residual);
  void restart();
  void take_back_augmentation();

  /// Returns the error of the augmentation of each contact, over its pair's tolerance. Collective.
  std::vector<double> augmentation_errors() const;
  /// Returns the largest of these errors, or the penetration in pairs without a tolerance in units
  /// of 1e-5 facets, if that is larger. Collective.
  double find_penetration() const;
  /// Returns the force that round-off of positions causes in the stiffest penalty. Collective.
  double find_spring_round_off() const;
  /// Returns the factors up to which penalties are 10 E/h. Collective.
  std::vector<double> stiffening_left() const;
  /// Returns the names of the pairs whose penalties cause most of the round-off. Collective.
  std::string stiffest_pairs() const;
  std::vector<std::vector<SlaveForce>> slave_forces() const;
  /// Returns the friction of each contact at the last update. Collective.
  std::vector<FrictionUse> friction_uses() const;
  /// Returns the energy in the springs of each contact. Collective.
  std::vector<double> stored_energies() const;
  /// Returns the works of all contacts in the step, before commit(); `weight` as in
  /// ContactMeasures. Collective.
  StepWorks compute_step_works(double weight) const;
  /// Returns the load that the contacts of a tool exert. Collective.
  ContactLoad compute_load(std::size_t tool) const;

  /// Returns the part of the motion in which no node passes through anything. `obstacle`: set to a
  /// description of the first passage. Collective.
  double find_free_part(const ContactPath &path, std::string &obstacle) const;

private:
  MPI_Comm communicator_;
  double reach_; ///< largest coordinate of the scene [length]
};

} // namespace billet

#endif
