// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PREDICTOR_H
#define BILLET_SOLVE_IMPLICIT_PREDICTOR_H

#include "billet/solve/implicit/implicit_problem.h"

#include <memory>
#include <vector>

namespace billet {

class ImplicitMotion;

/// First guess of a step, as the trial state: where nothing drives the bodies the last state, else what is
/// known of the motion, else one linear step.
class Predictor {
public:
  explicit Predictor(ImplicitProblem &problem) : problem_(problem) {}
  virtual ~Predictor() = default;
  Predictor(const Predictor &) = delete;
  Predictor &operator=(const Predictor &) = delete;

  /// Guesses the end of the step to t without a solution. False where nothing that is known fits.
  /// `previous_step`: length of the last step if its increment may be continued, 0 else.
  virtual bool guess(double t, double previous_step);
  /// Whether another guess is to be tried where nodes would go through something: follow_tangent() knows
  /// contact.
  virtual bool has_alternative() const { return true; }
  /// Solves one linear step from the last state, into which the motion of tools and supports is put. False
  /// where it has no solution. Collective.
  bool follow_tangent(double t, NewtonIteration &iteration);

  /// A tool stopped or left at the end of the last step: the last increment says nothing of the next.
  void lose_pace() { has_lost_pace_ = true; }
  void commit() { has_lost_pace_ = false; }
  bool has_lost_pace() const { return has_lost_pace_; }

  /// Keeps the trial state as what a probe to t has found: the steps up to t begin from it, in part.
  void keep_probe(double t);
  void drop_probe() { probe_.reset(); }

  void save(StateWriter &writer, const OwnedNodes &nodes) const;
  void load(StateReader &reader, const OwnedNodes &nodes, bool is_exact);

protected:
  bool extrapolates() const;
  ImplicitProblem &problem_;

private:
  /// Limits of what is continued.
  struct Limits {
    /// Jump of a tool's or support's motion beside that motion: above, the last increment says little, and
    /// supports that do not move evenly would crush the elements beside them.
    static constexpr double max_jump = 0.1;
    /// Relative tolerance of the linear step where the solver is iterative: the iterations mend the rest.
    static constexpr double linear_tolerance = 1e-3;
    /// Slack of the yield condition in the linear step, see HenckyPlasticity::update().
    static constexpr double yield_slack = 1e-9;
  };
  struct ProbedState {
    double time;
    Vector displacements;
    std::vector<double> offsets;
  };
  /// False where something drives the bodies on.
  bool stay_at_rest(double t);
  /// False where tools or supports change their pace.
  bool continue_increment(double t, double previous_step);
  bool follow_probe(double t);
  /// Puts the supports' values at t into the trial state. False if that jumps.
  bool fit_to_supports(double t);
  /// Whether the motion of a tool does not go on at the pace of the last step.
  bool tool_jumps(const Tool &tool, double t, double previous_step) const;

  bool has_lost_pace_ = false;
  std::unique_ptr<ProbedState> probe_; ///< of the last probe, while steps may start from it
};

/// First guess of a step of implicit dynamics: the motion at constant acceleration.
class MotionPredictor final : public Predictor {
public:
  MotionPredictor(ImplicitProblem &problem, const ImplicitMotion &motion)
      : Predictor(problem), motion_(motion) {}
  /// False where the motion leads farther from balance than to stay.
  bool guess(double t, double previous_step) override;
  bool has_alternative() const override { return false; }

private:
  const ImplicitMotion &motion_;
};

} // namespace billet

#endif
