// SPDX-License-Identifier: LGPL-2.1-or-later
// Warnings of energies that fail to balance, and of hourglass energy, are printed once each, and only where
// they matter.
#include "billet/output/energy_watch.h"
#include "../testing.h"

namespace energy_watch_test {

using billet::EnergyLedger;
using billet::EnergyWatch;
using billet::testing::check;

namespace {

bool contains(const std::string &text, const std::string &what) {
  return text.find(what) != std::string::npos;
}

bool contains(const billet::DiagnosticList &messages, const std::string &what) {
  return !messages.empty() && contains(messages.front().text(), what);
}

EnergyLedger flight(const double kinetic, const double elastic) {
  EnergyLedger energies;
  energies.initial = 1.;
  energies.kinetic = kinetic;
  energies.elastic = elastic;
  return energies;
}

auto because(const EnergyWatch::Cause cause) {
  return [cause] { return cause; };
}

} // namespace

BILLET_TEST(energy_watch) {
  {
    EnergyWatch watch(EnergyWatch::Balance::is_reported);
    check("what balances is no matter", watch.check(0.1, flight(0.6, 0.4)).empty());
    check("nor is what is missing by 4 %", watch.check(0.2, flight(0.56, 0.4)).empty());
    const billet::DiagnosticList text = watch.check(0.3, flight(0.8, 0.4));
    check("a warning is printed if energy is made", contains(text, "time 0.3") && contains(text, "20 %"));
    check("with what to do", contains(text, "Reduce 'Error tolerance'"));
    check("with how bad it is", std::abs(*text.front().measure() - 0.2) < 1e-12);
    check("and the run goes on", watch.imbalance().empty());
  }
  {
    EnergyWatch watch(EnergyWatch::Balance::is_reported);
    const billet::DiagnosticList text =
        watch.check(0.3, flight(0.8, 0.4), because(EnergyWatch::Cause::low_penalties));
    check("of soft penalties the advice is another", contains(text, "20 %") &&
                                                         contains(text, "Increase 'Normal penalty'") &&
                                                         !contains(text, "lower penalty"));
  }
  {
    EnergyWatch watch(EnergyWatch::Balance::is_reported);
    check("of overlaps that stick, too",
          contains(watch.check(0.3, flight(0.8, 0.4), because(EnergyWatch::Cause::sticking_overlaps)),
                   "Choose 'Facets = bilinear'"));
  }
  {
    EnergyWatch watch(EnergyWatch::Balance::is_reported);
    check("of edges that slide on facets, too",
          contains(watch.check(0.3, flight(0.8, 0.4), because(EnergyWatch::Cause::contact_edges)),
                   "Swap 'Body' and 'Second body'"));
  }
  {
    EnergyWatch watch(EnergyWatch::Balance::is_reported), other(EnergyWatch::Balance::is_reported);
    check("and of laws",
          contains(watch.check(0.3, flight(0.8, 0.4), because(EnergyWatch::Cause::unstable_law)),
                   "loses its ellipticity") &&
              contains(other.check(0.3, flight(0.8, 0.4), because(EnergyWatch::Cause::inexact_dissipation)),
                       "'Elasticity = Hencky'"));
    unsigned int n_asked = 0;
    EnergyWatch balanced(EnergyWatch::Balance::is_reported);
    balanced.check(0.1, flight(0.6, 0.4), [&] {
      ++n_asked;
      return EnergyWatch::Cause::steps;
    });
    check("causes are asked for where there is an effect", n_asked == 0);
  }
  {
    EnergyWatch watch(EnergyWatch::Balance::is_kept, 0.3);
    check("less than the scene allows does not end the run",
          watch.check(0.3, flight(0.8, 0.4)).empty() && watch.imbalance().empty());
    check("more does", watch.check(0.4, flight(1., 0.4)).empty() &&
                           contains(watch.imbalance().what, "by 40 % of the maximum so far; allowed are 30 % "
                                                            "('Maximum energy drift')") &&
                           contains(watch.imbalance().advice, "The steps do not resolve"));
  }
  {
    EnergyWatch watch(EnergyWatch::Balance::is_reported);
    check("energy from nowhere does not hide itself", contains(watch.check(1., flight(100., 0.)), "balance"));
  }
  {
    EnergyWatch watch(EnergyWatch::Balance::is_left);
    check("no warning is printed if the run ends anyway", watch.check(1., flight(2., 0.)).empty());
  }
}

} // namespace energy_watch_test
