// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/algebra/newton.h"

#include "billet/algebra/epetra.h"

#include <NOX_Abstract_Group.H>
#include <NOX_Epetra_Vector.H>
#include <NOX_LineSearch_Generic.H>
#include <NOX_LineSearch_UserDefinedFactory.H>
#include <NOX_Solver_Factory.H>
#include <NOX_Solver_Generic.H>
#include <NOX_StatusTest_Generic.H>
#include <NOX_Utils.H>
#include <Teuchos_ParameterList.hpp>
#include <Teuchos_oblackholestream.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace billet {

namespace {

using Teuchos::RCP;
using Teuchos::rcp;
using ReturnType = NOX::Abstract::Group::ReturnType;

/// Limits of linear solutions and of the line search.
struct NonlinearSolverLimits {
  /// Tightest linear solution, as part of the residual that ends the iterations, and the loosest
  /// one, as part of the present residual.
  static constexpr double linear_part = 0.5, max_linear_tolerance = 0.1;
  /// Maximum number of cuts of a correction that leads to an inadmissible state, and the factor of
  /// each.
  static constexpr unsigned int max_cuts = 5;
  static constexpr double cut = 0.5;
  /// Maximum number of trials of regula falsi, and the limits from which on a trial is good enough,
  /// in general and if the residual stagnates. A limit is the work of the residual at the end of a
  /// correction over that at its start.
  static constexpr unsigned int max_trials = 4;
  static constexpr double enough = 0.8, enough_of_cycles = 0.3;
  /// Trial without a bracket, as part of the step so far.
  static constexpr double without_bracket = 0.5;
  /// Minimum distance of a trial from both ends of the bracket, as part of the bracket.
  static constexpr double from_ends = 0.1;
  /// Number of iterations in which the norm of the residual falls by less than this factor if it
  /// stagnates.
  static constexpr std::size_t window = 4;
  static constexpr double stagnation = 0.5;
};

struct HeldVector {
  Vector held;
};

/// Vector in NOX's interface, which operates on the values of ours.
class NoxVector final : private HeldVector, public NOX::Epetra::Vector {
public:
  NoxVector(const billet::Vector &values, const NOX::CopyType type)
      : HeldVector{values}, NOX::Epetra::Vector(Teuchos::rcpFromRef(as_epetra(held)),
                                                NOX::Epetra::Vector::CreateView) {
    if (type == NOX::ShapeCopy)
      held = 0.;
  }
  NoxVector(const NoxVector &) = delete;
  NoxVector &operator=(const NoxVector &other) {
    NOX::Epetra::Vector::operator=(other);
    return *this;
  }
  NOX::Abstract::Vector &operator=(const NOX::Abstract::Vector &other) override {
    return NOX::Epetra::Vector::operator=(other);
  }
  RCP<NOX::Abstract::Vector> clone(const NOX::CopyType type) const override {
    return rcp(new NoxVector(held, type));
  }

  billet::Vector &values() { return held; }
  const billet::Vector &values() const { return held; }
};

const Vector &values_of(const NOX::Abstract::Vector &vector) {
  return dynamic_cast<const NoxVector &>(vector).values();
}

/// System in NOX's interface: a point x with the quantities computed there.
class Group final : public NOX::Abstract::Group {
public:
  /// `residual_tolerance`: a residual that is this part of its scale is sufficient.
  Group(NonlinearSystem &system, const double residual_tolerance, const Vector &x)
      : system_(&system), residual_tolerance_(residual_tolerance), x_(rcp(new NoxVector(x, NOX::DeepCopy))),
        f_(rcp(new NoxVector(x, NOX::ShapeCopy))), newton_(rcp(new NoxVector(x, NOX::ShapeCopy))) {}

  Group(const Group &other, const NOX::CopyType type)
      : NOX::Abstract::Group(), system_(other.system_), residual_tolerance_(other.residual_tolerance_),
        x_(rcp(new NoxVector(other.x_->values(), type))), f_(rcp(new NoxVector(other.f_->values(), type))),
        newton_(rcp(new NoxVector(other.newton_->values(), type))) {
    if (type == NOX::DeepCopy)
      copy_flags(other);
  }

  NOX::Abstract::Group &operator=(const NOX::Abstract::Group &source) override {
    const auto &other = dynamic_cast<const Group &>(source);
    *x_ = *other.x_;
    *f_ = *other.f_;
    *newton_ = *other.newton_;
    copy_flags(other);
    return *this;
  }

  void setX(const NOX::Abstract::Vector &y) override {
    *x_ = y;
    has_f_ = has_tangent_ = has_newton_ = false;
  }
  void computeX(const NOX::Abstract::Group &from, const NOX::Abstract::Vector &direction,
                double step) override {
    x_->update(1., from.getX(), step, direction, 0.);
    has_f_ = has_tangent_ = has_newton_ = false;
  }

  ReturnType computeF() override {
    if (!has_f_) {
      has_f_ = system_->compute_residual(x_->values(), f_->values());
      scale_ = system_->residual_scale();
    }
    return has_f_ ? NOX::Abstract::Group::Ok : NOX::Abstract::Group::Failed;
  }
  ReturnType computeJacobian() override {
    if (!has_tangent_)
      has_tangent_ = system_->compute_tangent(x_->values());
    return has_tangent_ ? NOX::Abstract::Group::Ok : NOX::Abstract::Group::Failed;
  }
  ReturnType computeNewton(Teuchos::ParameterList &options) override {
    if (!has_newton_) {
      // The tolerance need not be tighter than the one that ends the iterations (Kelley, Iterative
      // Methods for Linear and Nonlinear Equations, 1995, eq. 6.20).
      const double enough =
          f_->norm() > 0. ? NonlinearSolverLimits::linear_part * residual_tolerance_ * scale_ / f_->norm()
                          : 0.;
      const double tolerance = std::min(NonlinearSolverLimits::max_linear_tolerance,
                                        std::max(options.get("Tolerance", 0.), enough));
      has_newton_ =
          has_f_ && has_tangent_ && system_->solve_tangent(f_->values(), newton_->values(), tolerance);
      newton_->scale(-1.);
    }
    return has_newton_ ? NOX::Abstract::Group::Ok : NOX::Abstract::Group::Failed;
  }

  bool isF() const override { return has_f_; }
  bool isJacobian() const override { return has_tangent_; }
  bool isNewton() const override { return has_newton_; }
  const NOX::Abstract::Vector &getX() const override { return *x_; }
  const NOX::Abstract::Vector &getF() const override { return *f_; }
  double getNormF() const override { return f_->norm(); }
  const NOX::Abstract::Vector &getGradient() const override {
    return *newton_;
  } // not used by line-search Newton
  const NOX::Abstract::Vector &getNewton() const override { return *newton_; }
  RCP<const NOX::Abstract::Vector> getXPtr() const override { return x_; }
  RCP<const NOX::Abstract::Vector> getFPtr() const override { return f_; }
  RCP<const NOX::Abstract::Vector> getGradientPtr() const override { return newton_; }
  RCP<const NOX::Abstract::Vector> getNewtonPtr() const override { return newton_; }
  RCP<NOX::Abstract::Group> clone(NOX::CopyType type) const override { return rcp(new Group(*this, type)); }

  NewtonState state() const { return {x_->values(), f_->values(), f_->norm(), scale_}; }
  const Vector &newton() const { return newton_->values(); }
  double max_step_length(const NOX::Abstract::Vector &direction) const {
    return system_->max_step_length(x_->values(), values_of(direction));
  }

private:
  void copy_flags(const Group &other) {
    has_f_ = other.has_f_;
    has_tangent_ = other.has_tangent_;
    has_newton_ = other.has_newton_;
    scale_ = other.scale_;
  }

  NonlinearSystem *system_;
  double residual_tolerance_;
  RCP<NoxVector> x_, f_, newton_;
  double scale_ = 0.;
  bool has_f_ = false, has_tangent_ = false, has_newton_ = false;
};

double dot(const NOX::Abstract::Vector &a, const NOX::Abstract::Vector &b) { return a.innerProduct(b); }

/// Shortens a correction that leads to an inadmissible state, and, on request, one at whose end the
/// residual does more work than at its start. In the second case regula falsi approaches the zero
/// of R·d (Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1, ch. 9).
class LineSearch final : public NOX::LineSearch::Generic {
public:
  explicit LineSearch(const bool by_energy) : by_energy_(by_energy) {}

  bool compute(NOX::Abstract::Group &group, double &step, const NOX::Abstract::Vector &direction,
               const NOX::Solver::Generic &solver) override {
    const NOX::Abstract::Group &old = solver.getPreviousSolutionGroup();
    step = dynamic_cast<const Group &>(old).max_step_length(direction);
    if (!(step > 0.))
      return false;
    if (!evaluate(group, step, direction, old)) {
      for (unsigned int cut = 0; cut < NonlinearSolverLimits::max_cuts; ++cut) {
        step *= NonlinearSolverLimits::cut;
        if (evaluate(group, step, direction, old))
          return true;
      }
      step = 0.;
      return false;
    }
    if (!by_energy_)
      return true;

    const double start = dot(direction, old.getF());
    double end = dot(direction, group.getF());
    const bool stagnates = is_stagnating(old.getNormF());
    const double enough = stagnates ? NonlinearSolverLimits::enough_of_cycles : NonlinearSolverLimits::enough;
    if (!(std::abs(end) > (stagnates ? enough : 1.) * std::abs(start)) || start == 0.)
      return true;
    double best_step = step, best = std::abs(end);
    double low = 0., low_value = start, high = step, high_value = end;
    for (unsigned int trial = 0;
         trial < NonlinearSolverLimits::max_trials && std::abs(end) > enough * std::abs(start); ++trial) {
      const bool brackets = low_value * high_value < 0.;
      step = brackets ? low - low_value * (high - low) / (high_value - low_value)
                      : NonlinearSolverLimits::without_bracket * high;
      step = std::clamp(step, low + NonlinearSolverLimits::from_ends * (high - low),
                        high - NonlinearSolverLimits::from_ends * (high - low));
      if (!evaluate(group, step, direction, old))
        break;
      end = dot(direction, group.getF());
      if (std::abs(end) < best) {
        best = std::abs(end);
        best_step = step;
      }
      if (end * low_value > 0.) {
        low = step;
        low_value = end;
      } else {
        high = step;
        high_value = end;
      }
    }
    if (step != best_step) {
      step = best_step;
      return evaluate(group, step, direction, old);
    }
    return true;
  }

private:
  static bool evaluate(NOX::Abstract::Group &group, const double step, const NOX::Abstract::Vector &direction,
                       const NOX::Abstract::Group &old) {
    group.computeX(old, direction, step);
    return group.computeF() == NOX::Abstract::Group::Ok;
  }

  /// Whether the residual has not decreased in some iterations. Contact chatter is a cycle in which
  /// each correction undoes the last one, with as much work.
  bool is_stagnating(const double norm) {
    norms_.push_back(norm);
    if (norms_.size() <= NonlinearSolverLimits::window)
      return false;
    norms_.erase(norms_.begin());
    return norms_.back() > NonlinearSolverLimits::stagnation * norms_.front();
  }

  bool by_energy_;
  std::vector<double> norms_; ///< norms of the last residuals
};

class LineSearchFactory final : public NOX::LineSearch::UserDefinedFactory {
public:
  explicit LineSearchFactory(const bool by_energy) : by_energy_(by_energy) {}
  RCP<NOX::LineSearch::Generic> buildLineSearch(const RCP<NOX::GlobalData> &,
                                                Teuchos::ParameterList &) const override {
    return rcp(new LineSearch(by_energy_));
  }

private:
  bool by_energy_;
};

/// Convergence test that calls the judge.
class Convergence final : public NOX::StatusTest::Generic {
public:
  explicit Convergence(const NewtonJudge &judge) : judge_(judge) {}

  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver,
                                          NOX::StatusTest::CheckType) override {
    const auto n = static_cast<unsigned int>(solver.getNumIterations());
    const NewtonState now = dynamic_cast<const Group &>(solver.getSolutionGroup()).state();
    NewtonVerdict verdict;
    if (n == 0) {
      verdict = judge_(n, now, nullptr);
    } else {
      const auto &before = dynamic_cast<const Group &>(solver.getPreviousSolutionGroup());
      const NewtonCorrection last{before.state(), before.newton()};
      verdict = judge_(n, now, &last);
    }
    status_ = verdict == NewtonVerdict::converged ? NOX::StatusTest::Converged
              : verdict == NewtonVerdict::failed  ? NOX::StatusTest::Failed
                                                  : NOX::StatusTest::Unconverged;
    return status_;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &stream, int) const override { return stream; }

private:
  const NewtonJudge &judge_;
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

RCP<Teuchos::ParameterList> make_options(const NewtonOptions &settings) {
  auto options = rcp(new Teuchos::ParameterList);
  options->set("Nonlinear Solver", "Line Search Based");
  // NOX prints nothing; the judge reports.
  const RCP<std::ostream> silence = rcp(new Teuchos::oblackholestream);
  options->sublist("Printing").set("Output Information", 0);
  options->sublist("Printing").set("Output Stream", silence);
  options->sublist("Printing").set("Error Stream", silence);
  options->sublist("Direction").set("Method", "Newton");
  auto &newton = options->sublist("Direction").sublist("Newton");
  newton.set("Rescue Bad Newton Solve", false);
  newton.sublist("Linear Solver").set("Tolerance", settings.linear_tolerance);
  if (settings.adapts_tolerance) {
    // η_k = γ (|R_k| / |R_{k−1}|)^α, but not below γ η_{k−1}^α while that is above 0.1: Eisenstat &
    // Walker, SIAM J. Sci. Comput. 17 (1996) 16–32, eq. (2.6). Contact needs a tighter start than
    // their 0.5.
    newton.set("Forcing Term Method", "Type 2");
    newton.set("Forcing Term Initial Tolerance", settings.max_linear_tolerance);
    newton.set("Forcing Term Maximum Tolerance", settings.max_linear_tolerance);
    newton.set("Forcing Term Minimum Tolerance", settings.linear_tolerance);
    constexpr double alpha = 2., gamma = 0.9;
    newton.set("Forcing Term Alpha", alpha);
    newton.set("Forcing Term Gamma", gamma);
  } else
    newton.set("Forcing Term Method", "Constant");
  auto &line_search = options->sublist("Line Search");
  line_search.set("Method", "User Defined");
  RCP<NOX::LineSearch::UserDefinedFactory> factory = rcp(new LineSearchFactory(settings.searches_lines));
  line_search.set("User Defined Line Search Factory", factory);
  return options;
}

} // namespace

NewtonEnd solve_by_newton(NonlinearSystem &system, const NewtonOptions &options, const NewtonJudge &judge,
                          Vector &x) {
  const RCP<Group> group = rcp(new Group(system, options.residual_tolerance, x));
  if (group->computeF() != NOX::Abstract::Group::Ok)
    return NewtonEnd::not_admissible_at_start;
  const RCP<Convergence> convergence = rcp(new Convergence(judge));
  auto status = NOX::StatusTest::Unevaluated;
  try {
    const auto solver = NOX::Solver::buildSolver(group, convergence, make_options(options));
    status = solver->getStatus();
    while (status == NOX::StatusTest::Unconverged || status == NOX::StatusTest::Unevaluated)
      status = solver->step();
    x = values_of(solver->getSolutionGroup().getX());
  } catch (const char *) {
    // a correction cannot be computed; NOX's text, "NOX Error", gives no reason.
    return NewtonEnd::failed;
  }
  return status == NOX::StatusTest::Converged ? NewtonEnd::converged : NewtonEnd::failed;
}

} // namespace billet
