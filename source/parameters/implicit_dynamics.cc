// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/implicit_dynamics.h"

#include <deal.II/base/parameter_handler.h>

#include <array>

namespace billet::parameters {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

namespace {

constexpr const char *newmark = "Newmark", *hht = "HHT-alpha", *generalised = "generalised-alpha";

} // namespace

void ImplicitDynamics::declare(ParameterHandler &prm) {
  prm.declare_entry(
      "Method", generalised, Patterns::Selection("Newmark|HHT-alpha|generalised-alpha"),
      "How accelerations follow from displacements. Newmark (1959): without numerical dissipation by "
      "itself; HHT-alpha (Hilber, Hughes & Taylor 1977) and generalised-alpha (Chung & Hulbert 1993): of "
      "second order, and damp what the step cannot resolve, which contact needs.");
  prm.declare_entry("Beta", "0.25", Patterns::Double(),
                    "Newmark: at least half of gamma, so that no step is too long to be stable.");
  prm.declare_entry("Gamma", "0.5", Patterns::Double(),
                    "Newmark: at least 0.5; more damps high frequencies, at the price of first order.");
  prm.declare_entry("Alpha", "-0.05", Patterns::Double(),
                    "HHT-alpha: from -1/3, the most dissipation, to 0, none.");
  prm.declare_entry(
      "Spectral radius", "0.8", Patterns::Double(),
      "Generalised-alpha: what a step leaves of the highest frequencies, from 0, nothing, to 1, "
      "everything.");
  prm.declare_entry("Mass", "consistent", Patterns::Selection("consistent|lumped"),
                    "consistent: that of the elements' shape functions; lumped: its row sums at the nodes, "
                    "as in explicit scenes.");
  prm.declare_entry("Error tolerance", "1e-3", Patterns::Double(),
                    "Automatic steps: a step is cut if the error of its time integration (Zienkiewicz & Xie "
                    "1991, root mean square over the mass) is above this part of the reference displacement, "
                    "and grows no faster than the error allows. 0: steps follow the iterations alone.");
  prm.declare_entry("Reference displacement", "0", Patterns::Double(),
                    "What the error tolerance is a part of. 0: the largest displacement so far (root mean "
                    "square over the mass), where the motion of whole bodies counts up to the largest one's "
                    "radius of gyration, and no less than a millionth of the scene's radius. [length]");
  prm.declare_entry("Largest drift", "0.05", Patterns::Double(),
                    "The run ends where the energies fail to balance by more than this part of the largest "
                    "energy so far. 0: it goes on, and 5 % are told.");
}

void ImplicitDynamics::parse(Reader &reader, const bool steps_are_fixed) {
  const std::string chosen = reader.text("Method");
  method = chosen == newmark ? Method::newmark
           : chosen == hht   ? Method::hilber_hughes_taylor
                             : Method::generalised_alpha;
  const std::array<std::pair<std::string, std::string>, 4> users = {
      {{"Beta", newmark}, {"Gamma", newmark}, {"Alpha", hht}, {"Spectral radius", generalised}}};
  for (const auto &[key, user] : users)
    if (user != chosen && reader.is_set(key))
      reader.reject(key, "no value: the method is " + chosen);

  gamma = reader.number("Gamma");
  if (gamma < 0.5)
    reader.reject("Gamma", "a number >= 0.5: less feeds vibrations with energy");
  beta = reader.number("Beta");
  if (2. * beta < gamma)
    reader.reject("Beta", "a number not below half of 'Gamma': less is unstable in long steps");
  alpha = reader.number("Alpha");
  constexpr double least_alpha = -1. / 3. - 1e-6; // -0.333333 is meant to be -1/3
  if (!(alpha >= least_alpha && alpha <= 0.))
    reader.reject("Alpha", "a number from -1/3 to 0");
  spectral_radius = reader.number("Spectral radius");
  if (!(spectral_radius >= 0. && spectral_radius <= 1.))
    reader.reject("Spectral radius", "a number from 0 to 1");
  mass = reader.text("Mass") == "lumped" ? Mass::lumped : Mass::consistent;
  error_tolerance = reader.not_negative("Error tolerance");
  reference_displacement = reader.not_negative("Reference displacement");
  largest_drift = reader.not_negative("Largest drift");
  if (steps_are_fixed)
    for (const std::string key : {"Error tolerance", "Reference displacement"})
      if (reader.is_set(key))
        reader.reject(key, "no value: steps are fixed");
  if (error_tolerance == 0. && reader.is_set("Reference displacement"))
    reader.reject("Reference displacement", "no value: there is no 'Error tolerance'");
  if (steps_are_fixed)
    error_tolerance = 0.;
}

} // namespace billet::parameters
