// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_SNAPSHOTS_H
#define BILLET_RUN_SNAPSHOTS_H

#include "billet/output/field_writer.h"
#include "billet/state.h"

namespace billet {

/// Schedule of field output: at the start, at the requested intervals, and at the end.
class Snapshots {
public:
  Snapshots(const parameters::Scene &parameters, FieldWriter &writer)
      : output_(parameters.output), end_(parameters.time_stepping.end_time), writer_(writer) {}

  /// Whether fields are due after this number of steps, at this time.
  bool is_due(unsigned int step, double time) const;
  /// Writes the fields if they are due. Collective.
  void after_step(unsigned int step, const Solution &solution);
  /// Writes the fields, once for each time. Collective.
  void write(const Solution &solution);

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  const parameters::Output &output_;
  double end_;
  FieldWriter &writer_;
  unsigned int n_intervals_ = 0;
  double last_ = -1.; ///< time of the last fields
};

} // namespace billet

#endif
