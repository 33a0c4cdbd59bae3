// SPDX-License-Identifier: LGPL-2.1-or-later
// Offsets of slaves' gaps: what an augmentation takes up and at which pace, what is taken back, what a
// stiffer penalty keeps, what of initial depths a ramp allows; and nodes that keep changing.
#include "billet/contact/gap_offsets.h"
#include "billet/contact/restless_nodes.h"

#include "../testing.h"

#include <optional>
#include <vector>

namespace gap_offsets_test {

using namespace billet;
using namespace billet::testing;

namespace {

using Gaps = std::vector<std::optional<double>>;

void augment(MultiplierOffsets &offsets, const Gaps &gaps_less_offset) {
  offsets.augment(gaps_less_offset.size(), [&](const std::size_t s) { return gaps_less_offset[s]; });
}

void check_multipliers() {
  MultiplierOffsets offsets;
  check("nothing is kept before the first augmentation", offsets.is_empty() && !offsets.is_used());
  augment(offsets, {-0.1, std::nullopt});
  check("the first augmentation takes up the gap", offsets[0] == 0.1);
  check("  of slaves that press", offsets[1] == 0. && offsets.is_used() && offsets.was_empty());
  // The penetration is 0.1 before it, and 0.05 after it: half of what was taken up has closed it.
  augment(offsets, {-0.15, std::nullopt});
  check("the next goes at the secant's pace", near(offsets[0], 0.1 + 2. * 0.05, 1e-14));
  // It hardly moves now, which would make the pace 10.
  augment(offsets, {-0.2 - 0.04, std::nullopt});
  check("  at most fourfold", near(offsets[0], 0.2 + 4. * 0.04, 1e-12));
  offsets.restart();
  check("a restart takes all back", offsets.is_empty() && offsets[0] == 0.);

  augment(offsets, {-0.1, -0.2});
  offsets.commit([](const std::size_t s) { return s == 0; });
  check("a step keeps those of slaves that press",
        offsets.at_start(0) == 0.1 && offsets.at_start(1) == 0. && offsets[1] == 0.);
  offsets.scale(4.);
  check("a stiffer penalty keeps the multiplier", offsets[0] == 0.1 / 4. && offsets.at_start(0) == 0.1 / 4.);
  offsets.set(std::nullopt);
  check("a checkpoint without them has none",
        offsets.is_empty() && offsets.was_empty() && !offsets.is_used());
}

void check_penetrations() {
  GapOffsets offsets;
  check("without offsets there is no lift", offsets.of(0).now == 0. && !offsets.are_used());
  offsets.penetrations.start(2);
  offsets.penetrations.add(0, 0.2);
  offsets.penetrations.set(1, -0.05);
  offsets.penetrations.set_allowed_part(0.75, 0.5);
  check("a depth counts by its part",
        offsets.of(0).now == -0.1 && near(offsets.of(0).at_start, -0.15, 1e-14));
  check("  and what the ramp takes of it in a step", near(offsets.penetrations.ramp(0), 0.05, 1e-14));
  check("a closed gap counts for good", offsets.of(1).now == 0.05 && offsets.of(1).at_start == 0.05);
  augment(offsets.augmentation, {-0.3, std::nullopt});
  check("offsets add up", near(offsets.of(0).now, 0.3 - 0.1, 1e-14) && offsets.of(1).now == 0.05);
}

void check_restless() {
  RestlessNodes nodes(2);
  const auto count = [&] {
    unsigned int n = 0;
    nodes.visit([&](const std::size_t, const unsigned int) { ++n; });
    return n;
  };
  nodes.count({1, 5});
  for (std::uint64_t i = 0; i < 2; ++i)
    nodes.count({i % 2, 5});
  check("a node may change as often as that", count() == 0 && nodes.is_counting());
  nodes.count({7, 5});
  check("one that changes more often is restless",
        count() == 1 && nodes.is_restless(0) && !nodes.is_restless(1));
  nodes.restart();
  nodes.count({8, 5});
  check("a step that starts anew forgets all", count() == 0);
}

} // namespace

BILLET_TEST(gap_offsets) {
  check_multipliers();
  check_penetrations();
  check_restless();
}

} // namespace gap_offsets_test
