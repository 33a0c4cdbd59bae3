// SPDX-License-Identifier: LGPL-2.1-or-later
// When energy that contact removes is reported, which causes the message names, and what is given back; and
// when forces that do not balance are reported.
#include "billet/solve/contact_losses.h"
#include "billet/solve/reactions.h"

#include "../testing.h"

#include <string>

namespace contact_losses_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;

namespace {

constexpr double energy = 200.; ///< the largest of the run

/// Whether losses of this part of the energy are reported, after others that have been watched.
bool is_reported(const double part, const double before = 0.) {
  ContactLosses losses;
  losses.add(ContactLosses::impacts, before * energy);
  losses.watch(energy, 0.);
  losses.add(ContactLosses::impacts, (part - before) * energy);
  return !losses.watch(energy, 1.).empty();
}

/// Whether a message names friction, which makes this part of the losses; crossings make the rest.
bool names_friction(const double part) {
  ContactLosses losses;
  losses.add(ContactLosses::friction, part * energy);
  losses.add(ContactLosses::crossings, (1. - part) * energy);
  return losses.watch(energy, 0.).at(0).what().find("tangential penalties") != std::string::npos;
}

void check_losses() {
  check("losses are reported that are a good part of the largest energy",
        !is_reported(0.01) && is_reported(0.2));
  check("again when they have grown much", is_reported(0.5, 0.1));
  check("  not before, whatever is reported", !is_reported(0.1, 0.1));
  check("a good part of them is named beside the largest cause",
        !names_friction(0.01) && names_friction(0.3));
  check("  the largest always", names_friction(0.6));
  ContactLosses none;
  none.add(ContactLosses::impacts, 1.);
  check("where there is no energy nothing is lost", none.watch(0., 0.).empty());

  ContactLosses losses;
  losses.add(ContactLosses::impacts, 3.);
  losses.add(ContactLosses::crossings, 2.);
  losses.add(ContactLosses::friction, 4.);
  check("what comes back is taken from crossings, then from impacts",
        losses.give_back(4.) == 4. && losses.of(ContactLosses::crossings) == 0. &&
            losses.of(ContactLosses::impacts) == 1.);
  check("  never from friction", losses.give_back(4.) == 1. && losses.total() == 4.);

  ContactLosses reported, restarted;
  reported.add(ContactLosses::impacts, 0.1 * energy);
  reported.watch(energy, 0.);
  restarted.load(reported.save());
  check("a restart knows what has been reported",
        near(restarted.total(), 0.1 * energy, 1e-15) && restarted.watch(energy, 1.).empty());
}

/// Whether reactions that differ from the loads of a model by this part of its forces are reported.
bool is_off_balance(const double part, const bool in_float, const double round_off = 0.) {
  ForceBalance balance;
  balance.size = 50.;
  balance.round_off = round_off * balance.size;
  balance.reactions[0] = part * balance.size;
  return !check_force_balance(balance, 0., in_float).empty();
}

void check_balance() {
  check("forces balance to round-off", !is_off_balance(1e-12, false) && is_off_balance(1e-6, false));
  check("  of float, if they are in it", !is_off_balance(1e-6, true) && is_off_balance(0.1, true));
  check("  or of positions", !is_off_balance(1e-3, false, 1e-2) && is_off_balance(0.1, false, 1e-2));
}

} // namespace

BILLET_TEST(contact_losses) {
  check_losses();
  check_balance();
}

} // namespace contact_losses_test
