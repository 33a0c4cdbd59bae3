// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_START_GAP_WATCH_H
#define BILLET_SOLVE_START_GAP_WATCH_H

#include "billet/contact/contacts.h"
#include "billet/diagnostics.h"
#include "billet/state.h"

#include <vector>

namespace billet {

/// Watches pairs that close initial gaps or allow initial penetrations. Nodes keep what they had at
/// the start. Where that differs from node to node, it no longer fits once the partner has slid by
/// a facet.
class StartGapWatch {
public:
  explicit StartGapWatch(const Scene &scene);

  /// Adds an accepted step that ends at time `t`. Collective.
  void add(const Contacts &contacts, double t, MPI_Comm communicator);
  /// Returns a warning for each pair whose gaps at the start differ by too much after a slide by a
  /// facet. The limit is a tenth of the indentation F/(E √A) of the softer body.
  DiagnosticList judge() const;

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  struct Pair {
    std::size_t index; ///< in the contacts with tools, or of bodies
    bool has_tool;
    std::string name;
    double young_modulus;   ///< of the softer body
    double max_force = 0.;  ///< Σ p A over the run [force]
    double part = 0.;       ///< largest difference over the indentation
    double difference = 0.; ///< of the gaps at that time [length]
    double slide = 0., time = 0.;
  };
  std::vector<Pair> pairs_;
};

} // namespace billet

#endif
