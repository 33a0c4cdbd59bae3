// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_EVALUATION_H
#define BILLET_CONTACT_SLAVE_EVALUATION_H

#include "billet/contact/facet_contact_parts.h"

#include <memory>

namespace billet {

/// The loop that finds what slave nodes touch and computes tractions and forces. Made once for the
/// method, with friction or without, which no node asks for.
class SlaveEvaluation {
public:
  virtual ~SlaveEvaluation() = default;
  SlaveEvaluation(const SlaveEvaluation &) = delete;
  SlaveEvaluation &operator=(const SlaveEvaluation &) = delete;

  /// Sets the states of all slaves at the end of a step that lasts so long, and adds forces to those of nodes
  /// with ghosts.
  virtual void run(double duration, FacetSearch::Positions &forces) = 0;

protected:
  SlaveEvaluation() = default;
};

/// The parts have to outlive the evaluation.
std::unique_ptr<SlaveEvaluation> make_slave_evaluation(FacetContactParts &parts);

} // namespace billet

#endif
