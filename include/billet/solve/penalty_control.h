// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_PENALTY_CONTROL_H
#define BILLET_SOLVE_PENALTY_CONTROL_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"
#include "billet/solve/load_paths.h"
#include "billet/solve/path_softness.h"
#include "billet/solve/solution.h"
#include "billet/state.h"

#include <string>
#include <vector>

namespace billet {

/// Raises the normal penalties of dynamic scenes, of pairs that leave them to the program, while penetration
/// takes more than a small part of the deformation along their load path, (L7) of doc/theory.md.
class PenaltyControl {
public:
  struct Pair {
    std::string name;
    bool may_be_raised;
  };
  /// `largest_raise`: at a time, at most; pairs with tools first.
  PenaltyControl(std::vector<Pair> pairs, const std::vector<LoadPath> &paths, double largest_raise);
  PenaltyControl(const Scene &scene, double largest_raise);

  /// Factor of a raise, after which softness is measured anew.
  static constexpr double largest_target = 4.;

  /// Whether there is a pair that leaves its penalty to the program.
  bool is_used() const;

  /// What all ranks know at a time.
  struct Energies {
    double time = 0.;
    std::vector<double> of_pairs;  ///< of penetration, pairs with tools first
    std::vector<double> of_bodies; ///< elastic and plastic
    EnergyLedger all;
  };
  /// Those of a solution whose ledger is that of this time. Collective.
  static Energies measure(const Solution &solution, const Scene &scene, double time, MPI_Comm communicator);
  /// By which factor the penalty of each pair is to be raised now, by at most `room` in all; 1: it
  /// stays. Of a time that it knows nothing is raised again.
  std::vector<double> raises(const Energies &energies, const std::vector<double> &room);
  /// What the last raises() began.
  DiagnosticList take_diagnostics();

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  struct Controlled {
    LoadPath parts;
    double left = 1.;      ///< factor by which penalties are still to be raised
    PathSoftness softness; ///< since the last raise
  };
  void judge(Controlled &path, const Energies &energies, const std::vector<double> &room);

  double largest_raise_;
  double time_ = 0.;            ///< of the last raises()
  double largest_kinetic_ = 0.; ///< so far
  std::vector<Pair> pairs_;
  std::vector<Controlled> paths_;
  DiagnosticList diagnostics_;
};

} // namespace billet

#endif
