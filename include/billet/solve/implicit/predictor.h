// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PREDICTOR_H
#define BILLET_SOLVE_IMPLICIT_PREDICTOR_H

#include "billet/solve/implicit/implicit_problem.h"

#include <memory>
#include <vector>

namespace billet {

class ImplicitMotion;

/// First guess of a step, as the trial state. It is the last state if nothing drives the bodies,
/// else an extrapolation of known motion, else one linear step.
class Predictor {
public:
  explicit Predictor(ImplicitProblem &problem) : problem_(problem) {}
  virtual ~Predictor() = default;
  Predictor(const Predictor &) = delete;
  Predictor &operator=(const Predictor &) = delete;

  /// Guesses the end of the step to t without a linear solution. Returns false if no known motion
  /// fits. `previous_step`: length of the last step if its increment may be continued, else 0.
  virtual bool guess(double t, double previous_step);
  /// Whether another guess is to be tried if nodes would pass through something: follow_tangent()
  /// includes contact.
  virtual bool has_alternative() const { return true; }
  /// Solves one linear step from the last state with the motion of tools and supports. Returns
  /// false if there is no solution. Collective.
  bool follow_tangent(double t, NewtonIteration &iteration);

  /// Notes that a tool stopped or was removed at the end of the last step: the last increment
  /// cannot be continued.
  void lose_pace() { has_lost_pace_ = true; }
  void commit() { has_lost_pace_ = false; }
  bool has_lost_pace() const { return has_lost_pace_; }

  /// Keeps the trial state as the solution of a probe to t: the steps up to t begin from a part of
  /// it.
  void keep_probe(double t);
  void drop_probe() { probe_.reset(); }

  void save(StateWriter &writer, const OwnedNodes &nodes) const;
  void load(StateReader &reader, const OwnedNodes &nodes, bool is_exact);

protected:
  bool extrapolates() const;
  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();

private:
  /// Limits of continued motion.
  struct Limits {
    /// Maximum jump in the motion of tools or supports, as part of that motion. Above it the last
    /// increment is a poor guess, and unevenly moving supports would crush the elements beside
    /// them.
    static constexpr double max_jump = 0.1;
    /// Relative tolerance of the linear step if the solver is iterative: the iterations correct the
    /// rest.
    static constexpr double linear_tolerance = 1e-3;
    /// Slack of the yield condition in the linear step, see HenckyPlasticity::update().
    static constexpr double yield_slack = 1e-9;
  };
  struct ProbedState {
    double time;
    Vector displacements;
    std::vector<double> offsets;
  };
  /// Keeps the last state. Returns false if anything drives the bodies.
  bool stay_at_rest(double t);
  /// Continues the last increment. Returns false if tools or supports change their rate.
  bool continue_increment(double t, double previous_step);
  bool follow_probe(double t);
  /// Sets the supports' values at t in the trial state. Returns false if that causes a jump.
  bool fit_to_supports(double t);
  /// Whether the motion of a tool departs from the rate of the last step.
  bool tool_jumps(const Tool &tool, double t, double previous_step) const;

  bool has_lost_pace_ = false;
  std::unique_ptr<ProbedState> probe_; ///< of the last probe, while steps may start from it
};

/// First guess of a step of implicit dynamics: the motion at constant acceleration.
class MotionPredictor final : public Predictor {
public:
  MotionPredictor(ImplicitProblem &problem, const ImplicitMotion &motion)
      : Predictor(problem), motion_(motion) {}
  /// Returns false if the guess is farther from balance than the last state.
  bool guess(double t, double previous_step) override;
  bool has_alternative() const override { return false; }

private:
  const ImplicitMotion &motion_;
};

} // namespace billet

#endif
