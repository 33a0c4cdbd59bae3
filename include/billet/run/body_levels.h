// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_BODY_LEVELS_H
#define BILLET_RUN_BODY_LEVELS_H

#include "billet/run/run_options.h"

#include <vector>

namespace billet {

/// Error of the finest of several meshes, each of half the element size of the one before.
struct MeshLevelError {
  double error = 0.;
  double order = 1.;    ///< of convergence
  bool is_known = true; ///< whether the differences fall, as they do where errors have an order
};

/// Extrapolates the error from the differences between each mesh and the next finer one, at least
/// one, coarsest first, (W6) of doc/theory/error_estimate.md, with its safety. A single difference
/// counts as of order `expected_order`. Differences that hardly fall have no order; then the
/// largest of the last two stands for the error.
MeshLevelError extrapolate(const std::vector<double> &differences, double expected_order = 1.);

/// Chooses levels of the bodies' meshes from run to run until the error is small enough. All bodies
/// begin at one level and rise together, to the given one at least. A body whose part of the error
/// is small, (W7), stays behind then; its part stays, too.
class BodyLevels {
public:
  /// `target`: the error allowed, until allow() gives another.
  BodyLevels(std::size_t n_bodies, int first, double target);

  /// Level of each body.
  const std::vector<int> &levels() const { return levels_; }
  /// Level of the bodies that still rise.
  int level() const { return level_; }
  /// Adds the run on levels(), with its difference from the run before; the first run's does not
  /// count.
  void add(double difference, const std::vector<BodyMesh> &bodies);
  void allow(double error) { target_ = error; }
  double allowed() const { return target_; }
  /// Whether error() has a value: there are two runs.
  bool has_error() const { return n_runs_ > 1; }
  /// Error of the last run, and the order of the bodies that have risen last.
  const MeshLevelError &error() const { return error_; }
  /// Whether the error is within the target. On meshes coarser than given it takes three of them,
  /// which show an order: two may miss the same detail.
  bool is_met() const {
    return has_error() && error_.is_known && error_.error <= target_ && (n_resolved_ > 2 || level_ >= 0);
  }
  /// Returns the elements of the next run but n − 1, over those of the last one.
  double growth(unsigned int n = 1) const;
  /// Returns how many times meshes have to rise until the target is met at this order, once error()
  /// is known.
  unsigned int rises_to_target() const;
  /// Begins the next run, on the levels that the last one asks for.
  void rise();
  /// Begins anew, with all bodies at the next level.
  void restart();

private:
  /// Bodies that the next run refines.
  std::vector<bool> find_rising() const;
  /// Returns the error of the bodies that stay behind in the next run.
  double error_behind() const;

  double target_;
  int level_;
  std::vector<int> levels_;
  std::vector<bool> has_risen_; ///< in the last run
  std::vector<BodyMesh> bodies_;
  std::vector<double> errors_;  ///< by body
  std::vector<double> growths_; ///< of the elements of each body, at its last rise
  /// Number of runs, and of the last ones, all of whose meshes are resolved.
  unsigned int n_runs_ = 0, n_resolved_ = 0;
  double difference_ = 0.; ///< of the last run, by the bodies that rise next once these are chosen
  MeshLevelError error_;
};

} // namespace billet

#endif
