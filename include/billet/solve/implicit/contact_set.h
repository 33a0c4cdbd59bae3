// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_CONTACT_SET_H
#define BILLET_SOLVE_IMPLICIT_CONTACT_SET_H

#include "billet/contact/contacts.h"

#include <algorithm>
#include <string>
#include <vector>

namespace billet {

/// All contacts of an implicit scene, and what they are on all ranks together. Values of each contact stand
/// in the order of Contacts.
class ContactSet : public Contacts {
public:
  ContactSet(const Scene &scene, const Discretization &discretization);

  /// Collects get(contact) of each contact, the largest or the smallest of all ranks. Collective.
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

  /// Computes gaps and tractions at `displacements` (ghosted), and adds −F_c [force] to `residual` (additive
  /// vector), contact by contact. Collective.
  void update(const Vector &displacements, Vector &residual);
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
  /// Names of the pairs whose penalties make most of the round-off. Collective.
  std::string stiffest_pairs() const;
  std::vector<std::vector<SlaveForce>> slave_forces() const;
  /// Energy in the springs of each contact. Collective.
  std::vector<double> stored_energies() const;
  /// Works of all contacts in the step, before commit(); `weight` as in RigidContact. Collective.
  StepWorks compute_step_works(double weight) const;
  /// Load that the contacts of a tool exert. Collective.
  ContactLoad compute_load(std::size_t tool) const;

  /// Part of the motion in which no node goes through anything; `obstacle` says who would. Collective.
  double find_free_part(const ContactPath &path, std::string &obstacle) const;

private:
  MPI_Comm communicator_;
  double reach_; ///< largest coordinate of the scene [length]
};

} // namespace billet

#endif
