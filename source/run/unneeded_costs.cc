// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/unneeded_costs.h"

#include "billet/diagnostic_kinds.h"
#include "billet/spent_time.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace billet {

namespace {

struct Unneeded {
  double seconds;
  std::string what, remedy;
};

std::vector<Unneeded> list_unneeded(const RunCosts &costs) {
  constexpr double of_symmetric = 0.5; // operations of LDLᵀ over those of LU
  constexpr double much = 0.1;         // of the time, for fields
  std::vector<Unneeded> list;
  if (!costs.slides && costs.unsymmetric_matrix > 0.)
    list.push_back(
        {(1. - of_symmetric) * costs.unsymmetric_matrix, "the unsymmetric matrix, though nothing slides",
         "'Contact tangent = symmetrised upper' makes it symmetric; it is exact where nothing slides"});
  if (!costs.self_contact_touches && costs.self_contact > 0.)
    list.push_back(
        {costs.self_contact, "self-contact, though no surface touches itself",
         "leave such pairs out, with 'Contact = all' by 'Self-contact = false' in 'General contact'"});
  double of_steps = 0.;
  for (const Unneeded &one : list)
    of_steps += one.seconds;
  if (costs.fields > much * costs.all)
    list.push_back({costs.fields, "the output of fields", "a larger 'Interval' in 'Output' writes fewer"});
  constexpr double finer = 0.1;
  // Twice as long steps make twice the error.
  constexpr double of_longer = 0.5;
  if (costs.target > 0. && costs.steps_error < finer * costs.target)
    list.push_back({costs.error_control + of_longer * std::max(0., costs.limited_steps - of_steps),
                    "steps that are ten times finer than the target requires, and their comparison",
                    "a larger 'Maximum step' or 'Initial step', where the scene sets them"});
  std::sort(list.begin(), list.end(), [](const auto &a, const auto &b) { return a.seconds > b.seconds; });
  return list;
}

} // namespace

bool helps_symmetrised_contact(const Scene &scene) {
  const auto has_friction = [](const auto &pair) { return pair.has_friction(); };
  const auto any = [&has_friction](const auto &pairs) {
    return std::any_of(pairs.begin(), pairs.end(), has_friction);
  };
  const bool is_exact =
      scene.parameters().solver.material_tangent.value == parameters::MaterialTangent::exact;
  const auto is_unsymmetric = [is_exact](const Body &body) {
    return (is_exact && !body.law->has_symmetric_moduli()) ||
           std::any_of(body.loads.begin(), body.loads.end(),
                       [](const AppliedLoad &load) { return load.load.has_unsymmetric_tangent(); });
  };
  return (any(scene.pairs()) || any(scene.body_pairs())) &&
         std::none_of(scene.bodies().begin(), scene.bodies().end(), is_unsymmetric);
}

RunCosts collect_costs(const Scene &scene, const Solution &solution, const RunReview &review) {
  constexpr double rounding = 1e-9;
  const EnergyLedger &energies = solution.state().energies;
  RunCosts costs;
  costs.all = SpentTime::on_all();
  if (helps_symmetrised_contact(scene))
    costs.unsymmetric_matrix = SpentTime::on(Work::unsymmetric_matrix);
  costs.self_contact = SpentTime::on(Work::self_contact);
  costs.fields = SpentTime::on(Work::fields);
  costs.error_control = SpentTime::on(Work::error_control);
  costs.limited_steps = SpentTime::on(Work::limited_steps);
  costs.slides = energies.friction > rounding * energies.of_elements();
  costs.self_contact_touches = review.self_contact_touches();
  return costs;
}

DiagnosticList find_unneeded_costs(const RunCosts &costs) {
  constexpr double much = 0.1, long_run = 1.;
  const std::vector<Unneeded> list = list_unneeded(costs);
  double sum = 0.;
  for (const Unneeded &one : list)
    sum += one.seconds;
  if (!(sum > much * costs.all && sum > long_run))
    return {};
  std::ostringstream text, advice;
  text.precision(2);
  text << "Of " << costs.all << " s the run spent about " << sum << " s on what it did not need:";
  for (const Unneeded &one : list) {
    text << (&one == list.data() ? " " : "; ") << one.seconds << " s on " << one.what;
    advice << (&one == list.data() ? "To save it: " : "; ") << one.remedy;
  }
  return {Diagnostic(diagnostic::unneeded_cost, text.str()).measure("seconds", sum).advice(advice.str())};
}

} // namespace billet
