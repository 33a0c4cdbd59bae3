// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_COUPLINGS_H
#define BILLET_CONTACT_CONTACT_COUPLINGS_H

#include "billet/algebra/matrix.h"
#include "billet/state.h"

#include <deal.II/base/index_set.h>

namespace billet {

/// Couplings of a contact pair, which the matrix contains in addition to those of elements. Contact
/// with a rigid tool has none, which are these; contact between bodies has BodyCouplings.
class ContactCouplings {
public:
  ContactCouplings() = default;
  virtual ~ContactCouplings() = default;
  ContactCouplings(const ContactCouplings &) = delete;
  ContactCouplings &operator=(const ContactCouplings &) = delete;

  /// Whether MatrixContact::add_tangent() has entries of this rank that the last find() did not
  /// include.
  virtual bool has_new() const { return false; }
  /// Finds the nodes that add_tangent() may couple, after update(). Collective.
  virtual void find() {}
  /// Adds the dofs whose rows add_tangent() writes to.
  virtual void add_foreign_dofs(dealii::IndexSet & /*dofs*/) const {}
  /// Adds the entries that add_tangent() writes.
  virtual void add_entries(SparsityPattern & /*pattern*/) const {}

  /// Saves the result of the last find(): another matrix pattern would change the bits of a run.
  virtual void save(StateWriter & /*writer*/) const {}
  /// Loads a saved result in place of find(). Returns false, on all ranks, if other ranks saved it
  /// or it belongs to another tangent.
  virtual bool load(const StateReader & /*reader*/) { return true; }
};

} // namespace billet

#endif
