// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_TARGET_MESH_H
#define BILLET_RUN_TARGET_MESH_H

#include "billet/run/simulation.h"

#include <vector>

namespace billet {

/// Error of the finest of several meshes, each of half the element size of the one before.
struct MeshLevelError {
  double error = 0.;
  double order = 1.;    ///< of convergence
  bool is_known = true; ///< whether the differences fall, as they do where errors have an order
};

/// Extrapolates the error from the differences between each mesh and the next finer one, at least one,
/// coarsest first (Richardson): with differences D_1 and D_2 the order is p = log2(D_1/D_2), at most 2, that
/// of forces and energies of trilinear bricks, and the error D_2/(2^p − 1). A single difference stands for
/// the error, as of first order. Differences that do not fall have no order; then the largest of the last two
/// stands for the error.
MeshLevelError extrapolate(const std::vector<double> &differences);

/// Runs a scene as run_simulation() does. With 'Target error of = everything', runs it on levels of the given
/// mesh from coarse to fine, each in a folder 'mesh_level_N' in the output folder, until the error of the
/// mesh is within its part of the target, or the finest level or the end of the memory is reached. The
/// results of the last level then are in the output folder itself, with mesh_levels.csv. Throws and returns
/// as run_simulation().
ExitCode run_to_target(const parameters::Scene &parameters, MPI_Comm communicator,
                       const RunOptions &options = {});

} // namespace billet

#endif
