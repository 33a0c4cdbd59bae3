// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_CONTACT_WEIGHTS_H
#define BILLET_SOLVE_IMPLICIT_CONTACT_WEIGHTS_H

namespace billet {

struct ForceState;

/// Weights of contact forces in a step. Here contact counts as all other forces; ContactDamping is
/// implicit dynamics.
class ContactWeights {
public:
  ContactWeights() = default;
  virtual ~ContactWeights() = default;
  ContactWeights(const ContactWeights &) = delete;
  ContactWeights &operator=(const ContactWeights &) = delete;

  /// Begins a step from these forces: chooses whether contact is damped in it. Collective.
  virtual void choose(const ForceState & /*start*/) {}
  /// Damps contact in the step that begins from these forces, so that it generates no energy.
  /// Collective.
  virtual void damp(const ForceState & /*start*/) {}

  /// Returns the weight of contact forces, and of their tangent, in the residual.
  virtual double at_end() const { return 1.; }
  /// Returns the weight of contact forces at the start of the step in their mean.
  virtual double at_start() const { return 0.5; }
};

} // namespace billet

#endif
