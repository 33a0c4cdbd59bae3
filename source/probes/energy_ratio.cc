// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/probes/probe.h"

#include <map>

namespace billet {

ProbeType energy_ratio_type();

namespace {

Probe make_energy_ratio(const TypeInput &input) {
  using Numerator = ProbedEnergies::Numerator;
  using Denominator = ProbedEnergies::Denominator;
  static const std::map<std::string, Numerator> numerators{
      {"kinetic", Numerator::kinetic},   {"hourglass", Numerator::hourglass}, {"contact", Numerator::contact},
      {"friction", Numerator::friction}, {"plastic", Numerator::plastic},     {"drift", Numerator::drift}};
  static const std::map<std::string, Denominator> denominators{{"internal", Denominator::internal},
                                                               {"external", Denominator::external},
                                                               {"total", Denominator::total}};
  return Probe{
      ProbedEnergies{numerators.at(input.text("Energy")), denominators.at(input.text("Relative to"))}};
}

} // namespace

ProbeType energy_ratio_type() {
  return {
      "energy ratio",
      "ratio of two energies of the whole scene",
      {{"Energy", "kinetic", TypeParameter::Kind::choice,
        "kinetic|hourglass|contact|friction|plastic|drift: Energy, work or dissipation above the line, as in "
        "the columns of the history."},
       {"Relative to", "internal", TypeParameter::Kind::choice,
        "internal|external|total: Energy below the line. The ratio is 0 unless it is > 0. internal: elastic "
        "and hourglass energy and plastic work. external: work of tools, loads and supports. total: sum of "
        "all energies."}},
      make_energy_ratio};
}

} // namespace billet
