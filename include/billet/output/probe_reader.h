// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_PROBE_READER_H
#define BILLET_OUTPUT_PROBE_READER_H

#include "billet/discretization/boundary_facets.h"
#include "billet/output/probe_rows.h"
#include "billet/solve/solution.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Reads the probes of a scene. Material points, nodes and faces are found once, in the undeformed
/// bodies.
class ProbeReader {
public:
  /// Throws InputError on all ranks if a probe has a point outside its body. Collective.
  ProbeReader(const Scene &scene, const Discretization &discretization);
  ~ProbeReader();
  ProbeReader(const ProbeReader &) = delete;
  ProbeReader &operator=(const ProbeReader &) = delete;

  bool empty() const { return probes_.empty(); }
  /// Returns the values of probe_columns(), the same on all ranks. The state must be up to date.
  /// Collective.
  std::vector<double> read(const Solution &solution) const;

private:
  class State;
  struct Placed;
  void place_points(Placed &placed) const;
  void place_faces(Placed &placed) const;
  void place_thickness(Placed &placed) const;

  ProbeRows read_points(const Placed &placed, const State &state) const;
  ProbeRows read_space(const Placed &placed, const State &state) const;
  ProbeRows read_nodes(const Placed &placed, const State &state) const;
  ProbeRows read_faces(const Placed &placed, const State &state) const;
  ProbeRows read_thickness(const Placed &placed, const State &state) const;
  ProbeRows read_travel(const Placed &placed, const State &state) const;
  std::vector<double> read_motion(const Placed &placed, const State &state) const;
  /// Returns the columns of these rows.
  std::vector<double> evaluate(const Placed &placed, const ProbeRows &rows) const;
  // One function for each alternative of Probe::where: the compiler finds a missing one.
  std::vector<double> read(const ProbedPoints &points, const Placed &placed, const State &state) const;
  std::vector<double> read(const ProbedFaces &, const Placed &placed, const State &state) const;
  std::vector<double> read(const ProbedThickness &, const Placed &placed, const State &state) const;
  std::vector<double> read(const ProbedTravel &, const Placed &placed, const State &state) const;
  std::vector<double> read(const ProbedEnergies &energies, const Placed &, const State &state) const;
  std::vector<double> read(const ProbedMotion &, const Placed &placed, const State &state) const;
  std::vector<double> read(const Placed &placed, const State &state) const;

  const Scene &scene_;
  const Discretization &discretization_;
  std::vector<std::unique_ptr<Placed>> probes_;
};

/// Returns the names of the columns of all probes.
std::vector<std::string> probe_columns(const Scene &scene);

} // namespace billet

#endif
