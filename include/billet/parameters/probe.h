// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_PROBE_H
#define BILLET_PARAMETERS_PROBE_H

#include "billet/parameters/reader.h"
#include "billet/probes/probe.h"

#include <string>
#include <vector>

namespace billet::parameters {

/// One named subsection of Probes.
struct Probe {
  std::string name;
  std::string type;
  billet::Probe probe;
  Located<std::string> body;        ///< empty: the only one
  BoundaryIds boundary_ids;         ///< of probes of faces
  BoundaryIds opposite_ids;         ///< of the thickness
  std::vector<std::string> console; ///< columns, without the probe's name
  std::string origin;
  std::string origin_of_quantities, origin_of_energy;

  /// Returns the name of one of its columns in the history.
  std::string full_name(const std::string &column) const;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

} // namespace billet::parameters

#endif
