// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_EVALUATION_H
#define BILLET_CONTACT_SLAVE_EVALUATION_H

#include "billet/contact/facet_contact_parts.h"

#include <memory>

namespace billet {

/// Loop over slave nodes that finds the touched facets and computes tractions and forces. Method
/// and friction are fixed at construction, so that no node tests for them.
class SlaveEvaluation {
public:
  virtual ~SlaveEvaluation() = default;
  SlaveEvaluation(const SlaveEvaluation &) = delete;
  SlaveEvaluation &operator=(const SlaveEvaluation &) = delete;

  /// Sets the states of all slaves at the end of a step of this duration [time], and adds the
  /// forces on nodes, including ghosts.
  virtual void run(double duration, FacetSearch::Positions &forces) = 0;

protected:
  SlaveEvaluation() = default;
};

/// Makes the evaluation. The parts must outlive it.
std::unique_ptr<SlaveEvaluation> make_slave_evaluation(FacetContactParts &parts);

} // namespace billet

#endif
