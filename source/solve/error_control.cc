// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/error_control.h"

namespace billet {

void ErrorControl::accept(const double h, const Forces &forces, const double residual,
                          const double penetration) {
  const double force = course_.size_of(forces);
  course_.accept(h, force);
  iterations_ += residual * force * h;
  steps_.accept(h, forces.size());
  penetrations_.accept(h, force, penetration);
}

ErrorControl::Estimate ErrorControl::estimate() const {
  const double work = course_.work();
  if (!(work > 0.))
    return {};
  return {steps_.integral() / work, penetrations_.integral() / work, iterations_ / work};
}

void ErrorControl::save(StateWriter &writer) const {
  writer.write("errors", {iterations_});
  course_.save(writer);
  steps_.save(writer);
  penetrations_.save(writer);
}

void ErrorControl::load(const StateReader &reader) {
  iterations_ = reader.read("errors", 1)[0];
  course_.load(reader);
  steps_.load(reader);
  penetrations_.load(reader);
}

} // namespace billet
