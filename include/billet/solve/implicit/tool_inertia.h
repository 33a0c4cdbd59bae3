// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_TOOL_INERTIA_H
#define BILLET_SOLVE_IMPLICIT_TOOL_INERTIA_H

#include "billet/solve/solution.h"
#include "billet/state.h"

#include <cstddef>

namespace billet {

/// Inertia of driven tools in a step. Here no tool has a mass; HeavyTools is implicit dynamics.
class ToolInertia {
public:
  ToolInertia() = default;
  virtual ~ToolInertia() = default;
  ToolInertia(const ToolInertia &) = delete;
  ToolInertia &operator=(const ToolInertia &) = delete;

  virtual bool has_mass(const std::size_t /*tool*/) const { return false; }
  /// Returns the residual of a tool except the weighted force that it exerts and its load.
  virtual double residual(const std::size_t /*tool*/, const double /*offset*/) const { return 0.; }
  /// Returns the derivative of that residual by the offset.
  virtual double slope(const std::size_t /*tool*/) const { return 0.; }
  /// Accepts the step. `exerted`: on the bodies, along the tool's direction or about its axis.
  virtual void commit(const std::size_t /*tool*/, const double /*offset*/, const double /*exerted*/,
                      const double /*load*/, EnergyLedger & /*energies*/) {}
  /// Removes a tool. Returns its kinetic energy.
  virtual double remove(const std::size_t /*tool*/) { return 0.; }
  /// Saves the state of a tool at the start of the step to the tool's group.
  virtual void save(const std::size_t /*tool*/, StateWriter & /*writer*/) const {}
};

} // namespace billet

#endif
