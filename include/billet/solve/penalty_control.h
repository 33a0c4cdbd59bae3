// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_PENALTY_CONTROL_H
#define BILLET_SOLVE_PENALTY_CONTROL_H

#include "billet/contact/contact_penalties.h"
#include "billet/diagnostics.h"
#include "billet/scene/scene.h"
#include "billet/solve/load_paths.h"
#include "billet/solve/path_softness.h"
#include "billet/solve/solution.h"
#include "billet/solve/stick_softness.h"
#include "billet/state.h"

#include <deal.II/base/mpi.h>

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Raises penalties of dynamic scenes for pairs with automatic penalties. Normal penalties rise
/// while penetration exceeds a small part of the deformation along their load path, (L8) of
/// doc/theory.md. Tangential penalties rise while sticking friction is too small by more than a
/// small part, (L9).
class PenaltyControl {
public:
  struct Pair {
    std::string name;
    bool may_be_raised, may_be_raised_tangentially;
  };
  /// Factors for the normal and the tangential penalty of a pair.
  struct Factors {
    double normal = 1., tangential = 1.;
    bool raises() const { return normal > 1. || tangential > 1.; }
  };
  /// Maximum factors by which normal penalties rise at a time. In explicit scenes they rise slowly,
  /// so that nodes settle without an impact; in implicit ones softness is measured anew after a
  /// raise.
  static constexpr double in_explicit_scenes = 1.1, in_implicit_scenes = 4.;
  /// Pairs with tools come first.
  PenaltyControl(std::vector<Pair> pairs, const std::vector<LoadPath> &paths, double max_raise);
  /// Collective.
  PenaltyControl(const Scene &scene, const Discretization &discretization, double max_raise);

  /// Whether there is a pair with an automatic penalty.
  bool is_used() const;

  /// Energies at a time, the same on all ranks.
  struct Energies {
    double time = 0.;
    std::vector<double> of_pairs;  ///< of penetration, pairs with tools first
    std::vector<double> of_bodies; ///< elastic and plastic
    EnergyLedger all;
    std::vector<StickSoftness> sticking; ///< of pairs
  };
  /// Returns the factors by which the penalties of a contact may still rise. Collective.
  Factors room_of(const ContactPenalties &penalties, const MPI_Comm communicator) const {
    const std::vector<double> left{penalties.stiffening_left(), penalties.tangential_stiffening_left()};
    std::vector<double> minimum(left.size());
    dealii::Utilities::MPI::min(left, communicator, minimum);
    return {max_in_all * minimum[0], max_in_all * minimum[1]};
  }
  /// Returns the energies of a solution whose ledger is that of this time. Collective.
  Energies measure(const Solution &solution, std::size_t n_bodies, double time, MPI_Comm communicator) const;
  /// Returns the factors by which the penalties of each pair are to be raised now, at most by
  /// `room`; 1 means unchanged. A time that is not later than the last one raises nothing.
  std::vector<Factors> raises(const Energies &energies, const std::vector<Factors> &room);
  /// Returns messages about raises that the last raises() began.
  DiagnosticList take_diagnostics();

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  /// Maximum raise beyond 10 E/h. Bodies that are confined and nearly incompressible are many times
  /// as stiff as E.
  static constexpr double max_in_all = 1e5;
  struct Controlled {
    LoadPath parts;
    double left = 1.;      ///< remaining factor of the present raise
    PathSoftness softness; ///< since the last raise
  };
  void judge(Controlled &path, const Energies &energies, const std::vector<Factors> &room);
  double tangential_raise(std::size_t pair, const Energies &energies, double room);
  /// `room`: maximum factor by which the penalty may still rise.
  void describe(const std::string &penalty, std::size_t pair, double time, double factor, double room,
                const std::string &reason);

  double max_raise_;
  double time_ = 0.;        ///< of the last raises()
  double max_kinetic_ = 0.; ///< so far
  std::vector<Pair> pairs_;
  std::vector<Controlled> paths_;
  std::optional<StickSprings> stick_springs_; ///< none if no penalty is automatic
  DiagnosticList diagnostics_;
};

} // namespace billet

#endif
