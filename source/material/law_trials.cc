// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/law_trials.h"

#include "billet/material/elasticity.h"
#include "billet/material/hardening.h"
#include "billet/material/hencky.h"
#include "billet/material/hypoelastic.h"
#include "billet/material/user_subroutine.h"

#include <deal.II/physics/transformations.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

/// Limits of the findings, as relative errors.
struct Limits {
  /// Round-off, and the tolerance of iterations inside a law.
  static constexpr double objectivity = 1e-6;
  /// In steps to `small_step`. Newton's method then gains nearly two digits per iteration.
  static constexpr double tangent = 0.02, small_step = 0.01;
  static constexpr double symmetry = 1e-8;
  /// Bound for a subroutine's tangent whose symmetric part counts.
  static constexpr double lost_symmetry = 0.02;
  /// Errors of the trapezoidal rule over the paths, as part of the work.
  static constexpr double dissipation = 1e-3, balance = 0.02;
  /// Between ten steps and a hundred.
  static constexpr double steps = 0.05;
  static constexpr double drift = 0.01;
  /// Round-off, which follows from other numbers.
  static constexpr double units = 1e-8;
};

const Tensor<2, 3> unit = dealii::unit_symmetric_tensor<3>();

/// Largest error, and words about where it is. Not a number as soon as one error is none.
struct Worst {
  double error = 0.;
  std::string where;
  std::size_t n = 0; ///< count of errors

  void add(const double found, const std::function<std::string()> &describe) {
    ++n;
    if (!std::isnan(error) && !(found <= error)) {
      error = found;
      where = describe();
    }
  }
  /// Makes the finding, which fails if there was no error at all, not even 0.
  Finding judge(const std::string &property, const double allowed, const std::string &remark) const {
    return Finding::judge(property, n > 0 ? error : std::numeric_limits<double>::quiet_NaN(), allowed,
                          remark + (n == 0          ? "; the law refuses all steps"
                                    : where.empty() ? ""
                                                    : "; " + where));
  }
};

std::string number(const double x) {
  std::ostringstream text;
  text.precision(2);
  text << x;
  return text.str();
}

std::string counted(const std::size_t n, const std::string &what) { return std::to_string(n) + " " + what; }

} // namespace

double TrialNumbers::logarithmic(const double low, const double high) {
  return std::exp((*this)(std::log(low), std::log(high)));
}

SymmetricTensor<2, 3> TrialNumbers::strain() {
  SymmetricTensor<2, 3> result;
  do
    for (unsigned int i = 0; i < 6; ++i)
      result.access_raw_entry(i) = (*this)(-1., 1.);
  while (!(result.norm() > 0.1));
  result = dealii::deviator(result) + 0.1 * (dealii::trace(result) / 3.) * dealii::unit_symmetric_tensor<3>();
  return result / result.norm();
}

Tensor<2, 3> TrialNumbers::rotation(const double angle) {
  Tensor<1, 3> axis;
  do
    for (unsigned int i = 0; i < 3; ++i)
      axis[i] = (*this)(-1., 1.);
  while (!(axis.norm() > 0.1));
  return dealii::Physics::Transformations::Rotations::rotation_matrix_3d(Tensor<1, 3>(axis / axis.norm()),
                                                                         (*this)(-angle, angle));
}

std::vector<Finding> try_objectivity(const PointLaw &law, const CertificationSettings &settings) {
  constexpr unsigned int n_paths = 100, n_steps = 5;
  constexpr double max_angle = 2.5; // a rotation by pi in a step has no configuration at mid-step
  TrialNumbers random;
  Worst worst;
  std::size_t n = 0;
  for (unsigned int path = 0; path < n_paths; ++path) {
    LawPoint point(law, settings.temperature), turned(law, settings.temperature),
        late(law, settings.temperature);
    const Tensor<2, 3> Q = random.rotation(max_angle);
    const double size = random.logarithmic(1e-5, 0.1);
    Tensor<2, 3> F = unit;
    if (!point.evaluate(F, settings.dt) || !turned.evaluate(Q * F, settings.dt))
      continue;
    point.commit();
    turned.commit();
    for (unsigned int step = 0; step < n_steps; ++step) {
      F = (unit + size * random.strain()) * random.rotation(size) * F;
      const auto tau = point.evaluate(F, settings.dt), of_turned = turned.evaluate(Q * F, settings.dt);
      if (!tau || !of_turned)
        break;
      ++n;
      worst.add((*of_turned - turn(Q, *tau)).norm() / tau->norm(),
                [&] { return "steps of " + number(size) + ", after a rotation"; });
      point.commit();
      turned.commit();
      late.state_n() = point.state_n();
    }
    const auto tau = point.evaluate(F, settings.dt), of_late = late.evaluate(Q * F, settings.dt);
    if (tau && of_late)
      worst.add((*of_late - turn(Q, *tau)).norm() / tau->norm(),
                [&] { return "strains of " + number(size) + ", rotation in a step"; });
  }
  return {worst.judge("objectivity", Limits::objectivity, counted(n, "steps"))};
}

namespace {

/// Asymmetry of the moduli of the Lie derivative in these rates, relative to their norm.
double asymmetry(const StressRates &rates, const SymmetricTensor<2, 3> &tau) {
  constexpr unsigned int rows[6] = {0, 1, 2, 0, 0, 1}, columns[6] = {0, 1, 2, 1, 2, 2};
  double difference = 0., size = 0.;
  std::array<std::array<double, 6>, 6> c{};
  for (unsigned int r = 0; r < 6; ++r)
    for (unsigned int s = 0; s < 6; ++s) {
      const unsigned int i = rows[r], j = columns[r], k = rows[s], l = columns[s];
      const double H = 0.5 * ((i == k ? tau[j][l] : 0.) + (i == l ? tau[j][k] : 0.) +
                              (j == k ? tau[i][l] : 0.) + (j == l ? tau[i][k] : 0.));
      c[r][s] = 0.5 * (rates[r][3 * k + l] + rates[r][3 * l + k]) - H;
      size += c[r][s] * c[r][s];
    }
  for (unsigned int r = 0; r < 6; ++r)
    for (unsigned int s = 0; s < r; ++s)
      difference += 2. * (c[r][s] - c[s][r]) * (c[r][s] - c[s][r]);
  return std::sqrt(difference / size);
}

/// Kind of random paths, with two steps in the direction D before the one whose tangent is
/// compared.
struct Way {
  const char *name;
  /// Returns the increment of F in the last step.
  Tensor<2, 3> (*last)(const Tensor<2, 3> &D, double size, TrialNumbers &random);
};

const std::array<Way, 4> ways = {
    {{"loading", [](const Tensor<2, 3> &D, const double size, TrialNumbers &) { return unit + size * D; }},
     {"unloading",
      [](const Tensor<2, 3> &D, const double size, TrialNumbers &) { return unit - 1e-3 * size * D; }},
     {"reversal", [](const Tensor<2, 3> &D, const double size, TrialNumbers &) { return unit - size * D; }},
     {"shear", [](const Tensor<2, 3> &, const double size, TrialNumbers &random) {
        Tensor<2, 3> F = unit;
        F[0][1] = 2. * size;
        return random.rotation(size) * F;
      }}}};

/// Returns the increments of F along a path of this kind, relative to the step before.
std::array<Tensor<2, 3>, 3> make_path(const Way &way, const double size, TrialNumbers &random) {
  const Tensor<2, 3> D = random.strain();
  return {unit + size * D, unit + size * D, way.last(D, size, random)};
}

/// Strains the point to some 10 % in small steps; returns F at their end.
Tensor<2, 3> strain_before(LawPoint &point, TrialNumbers &random, const double dt) {
  constexpr unsigned int n_steps = 10;
  constexpr double size = 0.01;
  const Tensor<2, 3> increment = unit + size * Tensor<2, 3>(dealii::deviator(random.strain()));
  Tensor<2, 3> F = unit;
  for (unsigned int step = 0; step < n_steps; ++step) {
    if (!point.evaluate(increment * F, dt))
      break;
    F = increment * F;
    point.commit();
  }
  return F;
}

/// Finding about the symmetry of a subroutine's tangent, whose symmetric part counts.
Finding judge_lost_symmetry(const Worst &lost) {
  return lost.judge(
      "symmetry of the tangent", Limits::lost_symmetry,
      !(lost.error <= Limits::lost_symmetry)
          ? "only the symmetric part counts; if the rest is meant, set 'Unsymmetric tangent = true'"
          : "as the subroutine returns it");
}

} // namespace

std::vector<Finding> try_tangent(const PointLaw &law, const CertificationSettings &settings) {
  constexpr double difference = 1e-6, kink = 1e-3, max_step = 0.3;
  TrialNumbers random;
  Worst in_small_steps, asymmetric, lost;
  const auto *const user_law = find_user_subroutine(law);
  std::size_t n_kinks = 0, n_refused = 0;
  double safe_step = max_step;
  for (unsigned int path = 0; path < settings.n_paths; ++path) {
    const Way &way = ways[path % ways.size()];
    const double size = random.logarithmic(1e-5, max_step);
    LawPoint point(law, settings.temperature);
    const bool is_strained = path / ways.size() % 2 == 1;
    Tensor<2, 3> F = is_strained ? strain_before(point, random, settings.dt) : unit;
    StressRates promised{};
    std::optional<SymmetricTensor<2, 3>> tau;
    std::array<Tensor<2, 3>, 3> increments = make_path(way, size, random);
    for (std::size_t step = 0; step < increments.size(); ++step) {
      if (step > 0)
        point.commit();
      F = increments[step] * F;
      tau = point.evaluate(F, settings.dt, &promised);
      if (!tau)
        break;
    }
    if (!tau) {
      ++n_refused;
      continue;
    }
    const auto where = [&] {
      return std::string(way.name) + " by steps of " + number(size) +
             (is_strained ? " after a strain of 0.1" : "");
    };
    if (user_law != nullptr && size <= Limits::small_step)
      lost.add(user_law->lost_asymmetry(), where);
    if (law.has_symmetric_moduli())
      asymmetric.add(asymmetry(promised, *tau), [&] { return "in " + std::string(way.name); });
    const auto measured = point.differentiate(F, settings.dt, std::min(difference, 0.01 * size), kink);
    if (!measured) {
      ++n_kinks;
      continue;
    }
    const double error = relative_difference(promised, *measured, false);
    if (size <= Limits::small_step)
      in_small_steps.add(error, [&] { return "largest in " + where(); });
    if (!(error <= Limits::tangent))
      safe_step = std::min(safe_step, size);
  }
  std::vector<Finding> findings = {
      in_small_steps.judge("tangent", Limits::tangent,
                           counted(settings.n_paths, "paths, ") + counted(n_kinks, "at kinks, ") +
                               counted(n_refused, "refused") + "; steps to 1 %")};
  Finding safe;
  safe.property = "step of that tangent";
  safe.value = in_small_steps.n > 0 ? safe_step : 0.;
  safe.remark = "strain of a step up to which the tangent is as good; 0.3 is the largest of the trial";
  findings.push_back(safe);
  if (law.has_symmetric_moduli() && user_law != nullptr)
    findings.push_back(judge_lost_symmetry(lost));
  else if (law.has_symmetric_moduli())
    findings.push_back(asymmetric.judge("symmetry of the tangent", Limits::symmetry, "of the moduli"));
  return findings;
}

std::vector<Finding> try_energies(const PointLaw &law, const CertificationSettings &settings) {
  constexpr unsigned int n_paths = 40, n_turns = 4, n_steps = 100;
  TrialNumbers random;
  Worst falls, imbalance;
  for (unsigned int path = 0; path < n_paths; ++path) {
    LawPoint point(law, settings.temperature);
    const double size = random.logarithmic(1e-4, 0.2);
    Tensor<2, 3> F = unit;
    SymmetricTensor<2, 3> tau_n;
    double work = 0., dissipated = 0., stored = 0., highest = 0., scale = 0.;
    Worst fall, gap;
    bool is_refused = false;
    for (unsigned int turn = 0; turn < n_turns && !is_refused; ++turn) {
      const SymmetricTensor<2, 3> D = turn % 2 == 0 ? random.strain() : SymmetricTensor<2, 3>();
      // Every second turn leads back to the undeformed state.
      const Tensor<2, 3> start = F,
                         end = turn % 2 == 0 ? Tensor<2, 3>((unit + size * Tensor<2, 3>(D)) * F) : unit;
      for (unsigned int step = 1; step <= n_steps; ++step) {
        const double part = static_cast<double>(step) / n_steps;
        const Tensor<2, 3> next = (1. - part) * start + part * end,
                           L = (next - F) * dealii::invert(0.5 * (next + F));
        const auto tau = point.evaluate(next, settings.dt);
        if (!tau) {
          is_refused = true;
          break;
        }
        work += 0.5 * ((tau_n + *tau) * dealii::symmetrize(L));
        stored = point.stored_energy(next);
        dissipated = point.dissipated_energy();
        scale = std::max({scale, std::abs(work), std::abs(stored)});
        highest = std::max(highest, work - stored);
        fall.add(highest - (work - stored), [] { return ""; });
        gap.add(std::abs(work - stored - dissipated), [] { return ""; });
        tau_n = *tau;
        F = next;
        point.commit();
      }
    }
    const auto where = [&] { return "strains of " + number(size); };
    if (scale > 0.) {
      falls.add(fall.error / scale, where);
      imbalance.add(gap.error / scale, where);
    }
  }
  const double allowed =
      law.is_rate_form() || !law.has_exact_dissipation() ? Limits::balance : Limits::dissipation;
  const auto *const user_law = find_user_subroutine(law);
  if (user_law != nullptr && !user_law->computes_energies()) {
    Finding skipped;
    skipped.property = "dissipation >= 0";
    skipped.remark = "not tried: the subroutine returns no stored energy, so all work counts as stored";
    return {skipped};
  }
  return {falls.judge("dissipation >= 0", allowed, "largest fall over the work"),
          imbalance.judge("balance of energies", Limits::balance, "work less stored and dissipated energy")};
}

namespace {

/// Returns the stress at the end of a straight path to exp(strain), in equal steps over a time dt.
std::optional<SymmetricTensor<2, 3>> go_straight(const PointLaw &law, const SymmetricTensor<2, 3> &strain,
                                                 const unsigned int n_steps,
                                                 const CertificationSettings &settings) {
  LawPoint point(law, settings.temperature);
  std::optional<SymmetricTensor<2, 3>> tau;
  for (unsigned int i = 1; i <= n_steps; ++i) {
    tau = point.evaluate(exponential(static_cast<double>(i) / n_steps * strain), settings.dt / n_steps);
    if (!tau)
      break;
    point.commit();
  }
  return tau;
}

} // namespace

std::vector<Finding> try_steps(const PointLaw &law, const CertificationSettings &settings) {
  constexpr std::array<double, 7> sizes = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5};
  constexpr unsigned int n_directions = 8, n_few = 10, n_many = 100;
  constexpr double max_compared = 0.01, must_work = 0.1;
  TrialNumbers random;
  Worst worst;
  std::string refused;
  for (unsigned int d = 0; d < n_directions; ++d) {
    const SymmetricTensor<2, 3> D = random.strain();
    for (const double size : sizes) {
      const auto at_once = go_straight(law, size * D, 1, settings),
                 in_few = go_straight(law, size * D, n_few, settings),
                 in_many = go_straight(law, size * D, n_many, settings);
      if (!at_once || !in_few || !in_many) {
        if (size <= must_work)
          worst.add(std::numeric_limits<double>::quiet_NaN(),
                    [&] { return "refuses a step of " + number(size); });
        else
          refused = "; refuses steps of " + number(size);
      } else if (!std::isfinite(at_once->norm() + in_few->norm() + in_many->norm()))
        worst.add(std::numeric_limits<double>::quiet_NaN(),
                  [&] { return "no number for a step of " + number(size); });
      else if (size <= max_compared)
        worst.add((*in_few - *in_many).norm() / in_many->norm(), [&] { return "at " + number(size); });
    }
  }
  return {worst.judge("steps of 1e-6 to 0.5", Limits::steps,
                      "ten steps beside a hundred, to 1 % of strain" + refused)};
}

std::vector<Finding> try_repeated_stretches(const PointLaw &law, const CertificationSettings &settings) {
  constexpr unsigned int n_cycles = 1000, n_constraints = 20, n_paths = 4;
  constexpr double strain = 0.02, unloading = 0.2; // part of the deviator
  const double dt = 1e-9 * settings.dt;            // so that no stress relaxes
  TrialNumbers random;
  Worst worst;
  for (unsigned int path = 0; path < n_paths; ++path) {
    LawPoint point(law, settings.temperature), held(law, settings.temperature);
    const SymmetricTensor<2, 3> D = random.strain();
    auto last = point.evaluate(exponential(strain * D), settings.dt);
    if (!last)
      continue;
    point.commit();
    held.state_n() = point.state_n();
    const double back =
        std::min(0.1, unloading * dealii::deviator(*last).norm() / (2. * law.elastic().shear * strain));
    const Tensor<2, 3> low = exponential((1. - back) * strain * D),
                       high = exponential((1. - 0.9 * back) * strain * D);
    for (unsigned int i = 0; i < 2 * n_cycles && last; ++i) {
      last = point.evaluate(i % 2 == 0 ? low : high, dt);
      point.commit();
    }
    // The reference is held for the same time in few steps.
    auto of_held = last;
    for (unsigned int i = 0; i < n_constraints && of_held; ++i) {
      of_held = held.evaluate(high, dt * 2. * n_cycles / n_constraints);
      held.commit();
    }
    if (!last || !of_held)
      worst.add(std::numeric_limits<double>::quiet_NaN(), [] { return "refuses a cycle"; });
    else
      worst.add((*last - *of_held).norm() / of_held->norm(), [] { return ""; });
  }
  return {worst.judge("repeated stretches", Limits::drift, "drift of the stress in 1000 elastic cycles")};
}

std::vector<Finding> try_units(const PointLaw &law, const CertificationSettings &settings) {
  if (!settings.other_units)
    return {};
  const OtherUnits &other = *settings.other_units;
  if (other.law == nullptr)
    return {{"units", 0., 0., "not tried: " + other.why_not, Finding::Verdict::reported}};
  constexpr unsigned int n_paths = 50, n_steps = 5;
  TrialNumbers random;
  Worst worst;
  for (unsigned int path = 0; path < n_paths; ++path) {
    LawPoint point(law, settings.temperature), same(*other.law, other.temperature * settings.temperature);
    const double size = random.logarithmic(1e-4, 0.1), dt = settings.dt * random.logarithmic(1e-6, 1.);
    Tensor<2, 3> F = unit;
    for (unsigned int step = 0; step < n_steps; ++step) {
      F = (unit + size * random.strain()) * random.rotation(size) * F;
      const auto tau = point.evaluate(F, dt), of_same = same.evaluate(F, other.time * dt);
      if (!tau || !of_same)
        break;
      worst.add((*of_same / other.stress - *tau).norm() / tau->norm(),
                [&] { return "steps of " + number(size) + " in a time of " + number(dt); });
      point.commit();
      same.commit();
    }
  }
  return {worst.judge("units", Limits::units, counted(n_paths, "paths with parameters in other units"))};
}

std::vector<Finding> try_checkpoint(const PointLaw &law, const CertificationSettings &settings) {
  constexpr unsigned int n_steps = 20;
  TrialNumbers random;
  std::vector<Tensor<2, 3>> path = {unit};
  for (unsigned int step = 0; step < n_steps; ++step)
    path.push_back((unit + 0.01 * Tensor<2, 3>(random.strain())) * path.back());
  using Stress = std::optional<SymmetricTensor<2, 3>>;
  std::vector<Stress> expected(path.size());
  const auto follow = [&](LawPoint &point, const unsigned int from, const unsigned int to,
                          const auto &visit) {
    for (unsigned int step = from; step < to; ++step) {
      visit(step, point.evaluate(path[step], settings.dt));
      point.commit();
    }
  };
  LawPoint whole(law, settings.temperature);
  follow(whole, 1, n_steps, [&](const unsigned int step, const Stress &tau) { expected[step] = tau; });
  LawPoint before(law, settings.temperature), other(law, settings.temperature),
      after(law, settings.temperature);
  follow(before, 1, n_steps / 2, [](unsigned int, const Stress &) {});
  for (const Tensor<2, 3> &F : path) { // another point in between, as in a mesh
    other.evaluate(dealii::transpose(F), settings.dt);
    other.commit();
  }
  after.state_n() = before.state_n();
  Worst worst;
  follow(after, n_steps / 2, n_steps, [&](const unsigned int step, const Stress &tau) {
    if (tau && expected[step])
      worst.add((*tau - *expected[step]).norm() / expected[step]->norm(), [] { return ""; });
    else if (tau.has_value() != expected[step].has_value())
      worst.add(std::numeric_limits<double>::quiet_NaN(), [] { return "one of both refuses"; });
  });
  std::size_t n_named = 0;
  for (const StateField &field : law.fields())
    n_named += field.n_components;
  if (n_named != law.n_state())
    worst.add(std::numeric_limits<double>::quiet_NaN(),
              [] { return "the fields have other numbers than the state"; });
  return {worst.judge("checkpoint", 0., counted(law.n_state(), "numbers at a point; bit by bit"))};
}

namespace {

/// Returns the seconds of an update with moduli, the smallest of several measurements.
double measure_update(const PointLaw &law, const CertificationSettings &settings) {
  constexpr unsigned int n_updates = 2000, n_repetitions = 5;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned int repetition = 0; repetition < n_repetitions; ++repetition) {
    TrialNumbers random;
    LawPoint point(law, settings.temperature);
    Tensor<2, 3> F = unit;
    StressRates rates;
    const auto start = std::chrono::steady_clock::now();
    for (unsigned int i = 0; i < n_updates; ++i) {
      F[0][1] = 0.1 * i / n_updates;
      if (point.evaluate(F, settings.dt, &rates))
        point.commit();
    }
    const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
    least = std::min(least, duration.count() / n_updates);
  }
  return least;
}

} // namespace

std::vector<Finding> try_cost(const PointLaw &law, const CertificationSettings &settings) {
  constexpr double yield_strain = 1e-3;
  const double young =
      9. * law.elastic().bulk * law.elastic().shear / (3. * law.elastic().bulk + law.elastic().shear);
  const SharedLaw reference =
      make_hencky_law(law.elastic(), make_hardening(LinearHardening{yield_strain * young, 0.01 * young}));
  const double own = measure_update(law, settings), of_reference = measure_update(*reference, settings);
  Finding finding;
  finding.property = "cost beside J2";
  finding.value = own / of_reference;
  finding.remark = number(1e6 * own) + " us for an update with its tangent";
  return {finding};
}

} // namespace billet
