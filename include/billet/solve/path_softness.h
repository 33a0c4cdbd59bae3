// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_PATH_SOFTNESS_H
#define BILLET_SOLVE_PATH_SOFTNESS_H

#include <cstddef>
#include <vector>

namespace billet {

/// Part of penetration in the deformation along a load path, (L6) of doc/theory.md. It compares the
/// energy of penetration with that of the bodies' deformation, over the time in which the pairs
/// bear load.
class PathSoftness {
public:
  struct Limits {
    /// Energy of penetration, as part of all energy, below which penetration is irrelevant to
    /// forces.
    static constexpr double counts = 0.01;
  };

  /// Adds energies at this time. `all_energy`: total energy of reference, (L6).
  void add(double time, double penetration, double deformation, double all_energy);
  /// Returns the part by which forces of driven tools are too small. It is 0 if penetration holds
  /// less than the part `counts` of all energy, and so is irrelevant.
  double part(double counts = Limits::counts) const;
  /// Forgets all but the last energies.
  void restart() { penetration_ = deformation_ = all_ = 0.; }

  static constexpr std::size_t n_numbers = 7;
  void save(std::vector<double> &numbers) const;
  void load(const double *numbers);

private:
  struct Sample {
    double time = 0., penetration = 0., deformation = 0., all = 0.;
  };
  Sample last_;                                           ///< zero at time 0
  double penetration_ = 0., deformation_ = 0., all_ = 0.; ///< integrals over time
};

} // namespace billet

#endif
