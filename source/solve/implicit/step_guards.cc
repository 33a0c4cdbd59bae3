// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/step_guards.h"

namespace billet {

DiagnosticList StepGuards::commit(const double t, const NewtonReport &report) {
  round_off.commit(t, report);
  resultants.commit();
  const ImplicitParts &parts = problem_.parts();
  start_gaps.add(parts.contacts(), t, parts.communicator());
  return paths.check_motion(t);
}

DiagnosticList StepGuards::finish() const {
  DiagnosticList messages = round_off.finish();
  append(messages, start_gaps.judge());
  return messages;
}

void StepGuards::save(StateWriter &writer) const {
  round_off.save(writer);
  resultants.save(writer);
  start_gaps.save(writer);
}

void StepGuards::load(StateReader &reader) {
  round_off.load(reader);
  resultants.load(reader);
  start_gaps.load(reader);
}

} // namespace billet
