// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/newton.h"

#include <Epetra_Vector.h>
#include <NOX_Abstract_Group.H>
#include <NOX_Abstract_PrePostOperator.H>
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
#include <limits>
#include <sstream>
#include <vector>

namespace billet {

namespace {

using Teuchos::RCP;
using Teuchos::rcp;
using ReturnType = NOX::Abstract::Group::ReturnType;

const Epetra_Vector &epetra(const NOX::Abstract::Vector &vector) {
  return dynamic_cast<const NOX::Epetra::Vector &>(vector).getEpetraVector();
}

/// The problem as NOX sees it: a point x with what has been computed there.
class Group final : public NOX::Abstract::Group {
public:
  /// `force_tolerance`: a residual that is this part of the force scale is good enough.
  Group(NonlinearProblem &problem, const double force_tolerance, const Epetra_Vector &x)
      : problem_(&problem), force_tolerance_(force_tolerance),
        x_(rcp(new NOX::Epetra::Vector(x, NOX::DeepCopy))),
        f_(rcp(new NOX::Epetra::Vector(x, NOX::ShapeCopy))),
        newton_(rcp(new NOX::Epetra::Vector(x, NOX::ShapeCopy))) {}

  Group(const Group &other, const NOX::CopyType type)
      : NOX::Abstract::Group(), problem_(other.problem_), force_tolerance_(other.force_tolerance_),
        x_(rcp(new NOX::Epetra::Vector(*other.x_, type))), f_(rcp(new NOX::Epetra::Vector(*other.f_, type))),
        newton_(rcp(new NOX::Epetra::Vector(*other.newton_, type))) {
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
      has_f_ = problem_->compute_residual(x_->getEpetraVector(), f_->getEpetraVector());
      scale_ = problem_->force_scale();
      status_changes_ = problem_->status_changes();
    }
    return has_f_ ? NOX::Abstract::Group::Ok : NOX::Abstract::Group::Failed;
  }
  ReturnType computeJacobian() override {
    if (!has_tangent_)
      has_tangent_ = problem_->compute_tangent(x_->getEpetraVector());
    return has_tangent_ ? NOX::Abstract::Group::Ok : NOX::Abstract::Group::Failed;
  }
  ReturnType computeNewton(Teuchos::ParameterList &options) override {
    if (!has_newton_) {
      // No closer than what would end the iterations (Kelley, Iterative Methods for Linear and Nonlinear
      // Equations, 1995, eq. 6.20).
      const double enough = f_->norm() > 0. ? 0.5 * force_tolerance_ * scale_ / f_->norm() : 0.;
      const double tolerance = std::min(0.1, std::max(options.get("Tolerance", 0.), enough));
      has_newton_ = has_f_ && has_tangent_ &&
                    problem_->solve_tangent(f_->getEpetraVector(), newton_->getEpetraVector(), tolerance);
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

  double scale() const { return scale_; }
  double max_step_length(const NOX::Abstract::Vector &direction) const {
    return problem_->max_step_length(x_->getEpetraVector(), epetra(direction));
  }
  const StatusChanges &status_changes() const { return status_changes_; }

private:
  void copy_flags(const Group &other) {
    has_f_ = other.has_f_;
    has_tangent_ = other.has_tangent_;
    has_newton_ = other.has_newton_;
    scale_ = other.scale_;
    status_changes_ = other.status_changes_;
  }

  NonlinearProblem *problem_;
  double force_tolerance_;
  RCP<NOX::Epetra::Vector> x_, f_, newton_;
  double scale_ = 0.;
  StatusChanges status_changes_;
  bool has_f_ = false, has_tangent_ = false, has_newton_ = false;
};

double dot(const NOX::Abstract::Vector &a, const NOX::Abstract::Vector &b) { return a.innerProduct(b); }

/// Shortens a correction that leads to an inadmissible state, and, on request, one along which the residual
/// does more work at its end than at its start: then the zero of R·d is approached by regula falsi
/// (Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1, ch. 9).
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
      for (unsigned int cut = 0; cut < most_cuts_; ++cut) {
        step *= 0.5;
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
    const double enough = stagnates ? enough_of_cycles_ : enough_;
    if (!(std::abs(end) > (stagnates ? enough : 1.) * std::abs(start)) || start == 0.)
      return true;
    double best_step = step, best = std::abs(end);
    double low = 0., low_value = start, high = step, high_value = end;
    for (unsigned int trial = 0; trial < most_trials_ && std::abs(end) > enough * std::abs(start); ++trial) {
      const bool brackets = low_value * high_value < 0.;
      step = brackets ? low - low_value * (high - low) / (high_value - low_value) : 0.5 * high;
      step = std::clamp(step, low + 0.1 * (high - low), high - 0.1 * (high - low));
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

  /// Whether the residual has not got smaller in some iterations: nodes that touch, and touch no more, and
  /// touch again, are a cycle in which each correction undoes the last one, with as much work.
  bool is_stagnating(const double norm) {
    constexpr std::size_t window = 4;
    norms_.push_back(norm);
    if (norms_.size() <= window)
      return false;
    norms_.erase(norms_.begin());
    return norms_.back() > 0.5 * norms_.front();
  }

  static constexpr unsigned int most_cuts_ = 5, most_trials_ = 4;
  static constexpr double enough_ = 0.8, enough_of_cycles_ = 0.3;
  bool by_energy_;
  std::vector<double> norms_; ///< of residuals, the last ones
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

/// The four criteria (Q1), and the limit on iterations; keeps the record of the iterations.
class Convergence final : public NOX::StatusTest::Generic {
public:
  Convergence(const NonlinearProblem &problem, const parameters::Solver &settings, const Epetra_Vector &x_n,
              const bool accepts_stalled, NewtonReport &report)
      : problem_(problem), settings_(settings), x_n_(x_n), accepts_stalled_(accepts_stalled),
        report_(report) {}

  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver,
                                          NOX::StatusTest::CheckType) override {
    const auto &group = dynamic_cast<const Group &>(solver.getSolutionGroup());
    const auto n = static_cast<unsigned int>(solver.getNumIterations());
    const double norm = group.getNormF();
    const double scale = group.scale();
    const double residual_work = measure(solver, group, n);
    const ConvergenceMeasures &measures = report_.measures;

    // But for what contact's round-off leaves.
    const bool stagnates = n > 0 && norm > slow_ * last_norm_;
    last_norm_ = norm;
    const auto is_small = [&](const double contact_round_off) {
      // All that round-off may leave only where iterations no longer help.
      const double round_off = (stagnates ? 1. : certain_) * problem_.round_off_force() + contact_round_off;
      const bool is_exact = norm <= exact_residual * scale + round_off;
      const bool has_settled = measures.has_correction &&
                               measures.correction <= settings_.displacement_tolerance &&
                               measures.status <= settings_.force_tolerance;
      return norm <= settings_.force_tolerance * scale + round_off && (is_exact || has_settled) &&
             (n == 0 ||
              std::abs(residual_work) <= (settings_.energy_tolerance * scale + round_off) * increment_);
    };
    const double contact = problem_.contact_round_off_force(), cap = most_round_off * scale;
    const bool is_near = norm <= max_stalled_residual * scale;
    status_ = NOX::StatusTest::Unconverged;
    if (!std::isfinite(norm)) {
      report_.failure = "the residual is not a number";
      status_ = NOX::StatusTest::Failed;
    } else if (is_small(std::min(contact, cap))) {
      status_ = NOX::StatusTest::Converged;
    } else if (contact > cap && is_small(contact) && ++n_in_round_off_ > most_in_round_off_) {
      report_.is_stalled = is_near;
      report_.is_lost_in_round_off = !is_near;
      status_ = NOX::StatusTest::Converged;
    } else if (has_stalled(n) && is_near && measures.correction <= max_stalled_correction) {
      report_.is_stalled = true;
      status_ = accepts_stalled_ ? NOX::StatusTest::Converged : NOX::StatusTest::Failed;
      if (!accepts_stalled_)
        report_.failure = "after " + std::to_string(n) + " iterations the residual no longer falls";
    } else if (n >= settings_.most_iterations) {
      report_.failure = "no convergence in " + std::to_string(n) + " iterations";
      status_ = NOX::StatusTest::Failed;
    } else if (n >= 3 * window_ && has_stalled(n)) { // later, drift is a small part of the way it has made
      report_.failure =
          "given up after " + std::to_string(n) + " iterations, since the residual no longer falls";
      status_ = NOX::StatusTest::Failed;
    } else if (is_hopeless(n) && !may_still_settle(n)) {
      report_.failure = "given up after " + std::to_string(n) + " iterations, since at their pace " +
                        std::to_string(settings_.most_iterations) + " will not do";
      status_ = NOX::StatusTest::Failed;
    }
    if (report_.is_stalled || status_ == NOX::StatusTest::Failed)
      report_.criteria = measures.describe(settings_);
    if (status_ == NOX::StatusTest::Failed && std::isfinite(norm) && go_round(report_.iterations)) {
      report_.goes_round = true;
      report_.failure = "after " + std::to_string(n) +
                        " iterations they go to and fro between the same states, of which none is in balance";
    }
    // Residuals that are larger than estimated, but not by much, are round-off's, too.
    constexpr double by_much = 10.;
    largest_round_off_ = std::max(largest_round_off_, contact); // nodes may just have let go
    if (status_ == NOX::StatusTest::Failed)
      report_.is_lost_in_round_off =
          !report_.is_stalled && largest_round_off_ > cap && norm <= by_much * largest_round_off_;
    return status_;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &stream, int) const override { return stream; }
  /// Whether an iteration has come as near as round-off lets it, and that is not near enough.
  bool has_met_round_off() const { return n_in_round_off_ > 0; }

private:
  /// Sets the report's measures, and appends the iteration that led here. Returns R · δu.
  double measure(const NOX::Solver::Generic &solver, const Group &group, const unsigned int n) {
    const double norm = group.getNormF(), scale = group.scale();
    ConvergenceMeasures &measures = report_.measures;
    measures = {};
    measures.force = report_.force = scale > 0. ? norm / scale : 0.;
    const Epetra_Vector &x = epetra(group.getX());
    Epetra_Vector increment(x);
    increment.Update(-1., x_n_, 1.);
    increment.Norm2(&increment_);
    if (n == 0)
      return 0.;
    const auto &before = dynamic_cast<const Group &>(solver.getPreviousSolutionGroup());
    const Epetra_Vector &newton = epetra(before.getNewton());
    Epetra_Vector correction(x);
    correction.Update(-1., epetra(before.getX()), 1.);
    double residual_work = 0., length = 0., full_length = 0.;
    epetra(group.getF()).Dot(correction, &residual_work);
    correction.Norm2(&length);
    newton.Norm2(&full_length);
    const double before_scale = before.scale();
    report_.iterations.push_back({before_scale > 0. ? before.getNormF() / before_scale : 0.,
                                  std::abs(dot(before.getF(), before.getNewton())),
                                  full_length > 0. ? length / full_length : 1.});
    // Of a correction that was shortened, all counts: its length says nothing about how far there is to go.
    double largest_correction = 0., largest_increment = 0., largest_displacement = 0.;
    newton.NormInf(&largest_correction);
    increment.NormInf(&largest_increment);
    x.NormInf(&largest_displacement);
    largest_increment = std::max(largest_increment, least_increment_ * largest_displacement);
    measures.has_correction = true;
    measures.correction = largest_increment > 0. ? largest_correction / largest_increment : 0.;
    measures.energy = scale * increment_ > 0. ? std::abs(residual_work) / (scale * increment_) : 0.;
    measures.status = group.status_changes().part();
    measures.n_status_changes = group.status_changes().n;
    return residual_work;
  }
  /// Whether the residual no longer falls.
  bool has_stalled(const unsigned int n) const {
    const bool is_last = n >= settings_.most_iterations;
    return (n >= 2 * window_ && is_stagnant(report_.iterations, report_.force, window_)) ||
           (is_last && n >= window_ && is_stagnant(report_.iterations, report_.force, window_ / 2));
  }
  /// Whether the residual has stalled, and comes near enough to balance now and then.
  bool may_still_settle(const unsigned int n) const {
    if (n >= 3 * window_ || !has_stalled(n))
      return false;
    for (unsigned int back = 1; back < window_; ++back)
      if (report_.iterations[n - back].force <= max_stalled_residual)
        return true;
    return false;
  }
  /// Whether, at the mean pace of the last iterations, the residual would miss its tolerance in those that
  /// are left.
  bool is_hopeless(const unsigned int n) const {
    constexpr unsigned int window = window_;
    if (n < 2 * window)
      return false;
    const double before = report_.iterations[n - window].force;
    const double to_go = std::log(report_.force / settings_.force_tolerance);
    const double pace = std::log(before / report_.force) / window; // per iteration
    return to_go > 0. && pace * (settings_.most_iterations - n) < to_go;
  }

  const NonlinearProblem &problem_;
  const parameters::Solver &settings_;
  const Epetra_Vector &x_n_;
  const bool accepts_stalled_;
  NewtonReport &report_;
  static constexpr unsigned int window_ = 10; // of iterations, to see whether they get nearer
  // Of the largest displacement: smaller increments, as of a scene at rest, are no measure of corrections.
  static constexpr double least_increment_ = 1e-3;
  static constexpr unsigned int most_in_round_off_ = 3; // tries to come out of it
  static constexpr double slow_ = 0.1;                  // of the last residual
  static constexpr double certain_ = 0.01;              // of the estimate of round-off: its last bit
  double last_norm_ = 0., increment_ = 0.;              // |Δu|
  unsigned int n_in_round_off_ = 0;
  double largest_round_off_ = 0.;
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

RCP<Teuchos::ParameterList> make_options(const parameters::Solver &settings) {
  auto options = rcp(new Teuchos::ParameterList);
  options->set("Nonlinear Solver", "Line Search Based");
  // NOX speaks through the report alone.
  const RCP<std::ostream> silence = rcp(new Teuchos::oblackholestream);
  options->sublist("Printing").set("Output Information", 0);
  options->sublist("Printing").set("Output Stream", silence);
  options->sublist("Printing").set("Error Stream", silence);
  options->sublist("Direction").set("Method", "Newton");
  auto &newton = options->sublist("Direction").sublist("Newton");
  newton.set("Rescue Bad Newton Solve", false);
  newton.sublist("Linear Solver").set("Tolerance", settings.linear_tolerance);
  if (settings.forcing == parameters::Solver::Forcing::eisenstat_walker) {
    // η_k = γ (|R_k| / |R_{k−1}|)^α, but not below γ η_{k−1}^α while that is above 0.1: Eisenstat & Walker,
    // SIAM J. Sci. Comput. 17 (1996) 16–32, eq. (2.6). Contact wants a better start than their 0.5.
    newton.set("Forcing Term Method", "Type 2");
    newton.set("Forcing Term Initial Tolerance", largest_forcing_term);
    newton.set("Forcing Term Maximum Tolerance", largest_forcing_term);
    newton.set("Forcing Term Minimum Tolerance", settings.linear_tolerance);
    newton.set("Forcing Term Alpha", 2.);
    newton.set("Forcing Term Gamma", 0.9);
  } else
    newton.set("Forcing Term Method", "Constant");
  auto &line_search = options->sublist("Line Search");
  line_search.set("Method", "User Defined");
  RCP<NOX::LineSearch::UserDefinedFactory> factory =
      rcp(new LineSearchFactory(settings.line_search == parameters::Solver::LineSearch::energy));
  line_search.set("User Defined Line Search Factory", factory);
  return options;
}

} // namespace

std::string ConvergenceMeasures::describe(const parameters::Solver &tolerances) const {
  std::ostringstream text;
  text.precision(2);
  const auto add = [&](const char *what, const double value, const char *of_what, const double tolerance) {
    if (value > tolerance)
      text << (text.tellp() > 0 ? ", " : "") << what << value << of_what << " (tolerance " << tolerance
           << ")";
  };
  text << "residual " << force << " of the forces (tolerance " << tolerances.force_tolerance << ")";
  if (!has_correction)
    return text.str();
  add("energy ", energy, " of the step's work", tolerances.energy_tolerance);
  add("correction ", correction, " of the step's increment", tolerances.displacement_tolerance);
  if (n_status_changes > 0.)
    text << ", " << n_status_changes << (n_status_changes == 1. ? " change" : " changes")
         << " of contact status with " << status << " of the contact force (tolerance "
         << tolerances.force_tolerance << ")";
  return text.str();
}

bool is_stagnant(const std::vector<NewtonIteration> &iterations, const double last_force,
                 const std::size_t window) {
  constexpr double hardly_better = 0.7;
  if (iterations.size() < 2 * window)
    return false;
  double before = std::numeric_limits<double>::infinity(), now = last_force;
  for (std::size_t i = 0; i < iterations.size(); ++i) {
    double &best = i + window <= iterations.size() ? before : now;
    best = std::min(best, iterations[i].force);
  }
  return now > hardly_better * before;
}

bool go_round(const std::vector<NewtonIteration> &iterations) {
  constexpr std::size_t longest = 4, window = 2 * longest;
  constexpr double alike = 0.02, apart = 0.2;
  if (iterations.size() < window + longest)
    return false;
  const auto force = [&](const std::size_t back) { return iterations[iterations.size() - 1 - back].force; };
  for (std::size_t period = 2; period <= longest; ++period) {
    bool returns = true;
    double least = force(0), most = force(0);
    for (std::size_t back = 0; back < window; ++back) {
      returns = returns && std::abs(force(back) - force(back + period)) <= alike * force(back);
      least = std::min(least, force(back));
      most = std::max(most, force(back));
    }
    if (returns && most - least > apart * most)
      return true;
  }
  return false;
}

NewtonReport solve_newton(NonlinearProblem &problem, const parameters::Solver &settings,
                          const Epetra_Vector &x_n, Epetra_Vector &x, const bool accepts_stalled) {
  NewtonReport report;
  const RCP<Group> group = rcp(new Group(problem, settings.force_tolerance, x));
  if (group->computeF() != NOX::Abstract::Group::Ok) {
    report.failure = "the step's first guess is not admissible (det F <= 0 or not a number)";
    return report;
  }
  const RCP<Convergence> convergence = rcp(new Convergence(problem, settings, x_n, accepts_stalled, report));
  try {
    const auto solver = NOX::Solver::buildSolver(group, convergence, make_options(settings));
    auto status = solver->getStatus();
    while (status == NOX::StatusTest::Unconverged || status == NOX::StatusTest::Unevaluated)
      status = solver->step();
    report.converged = status == NOX::StatusTest::Converged;
    x = epetra(solver->getSolutionGroup().getX());
  } catch (const char *) { // where a correction cannot be computed; NOX's text, "NOX Error", says nothing
  }
  report.hardest = report.iterations.size();
  report.is_lost_in_round_off =
      report.is_lost_in_round_off || (!report.converged && convergence->has_met_round_off());
  if (!report.converged && report.failure.empty())
    report.failure =
        "the correction leads to inadmissible states (det F <= 0 or not a number), or the matrix is singular";
  return report;
}

} // namespace billet
