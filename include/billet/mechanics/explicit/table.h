// SPDX-License-Identifier: LGPL-2.1-or-later
// No include guard: one file for each instruction set and number type includes this once. It first
// defines BILLET_LANES, BILLET_SINGLE and BILLET_KERNEL_TABLE (the name of its table in kernel.h).
#include "billet/mechanics/explicit/assumed_strain.h"
#include "billet/mechanics/explicit/eight_point.h"
#include "billet/mechanics/explicit/one_point.h"

namespace billet::explicit_kernels {

// A new element or law needs its kernels in the table, and its place in these lists.
static_assert(static_cast<int>(LaneElement::assumed_strain) == 0 &&
                  static_cast<int>(LaneElement::mean_dilatation) == 1 &&
                  static_cast<int>(LaneElement::one_point) == 2 && n_lane_elements == 3,
              "the table has the kernels of these elements, in this order");
static_assert(static_cast<int>(LaneLaw::hencky) == 0 && static_cast<int>(LaneLaw::neo_hookean) == 1 &&
                  static_cast<int>(LaneLaw::hypoelastic) == 2 && n_lane_laws == 3,
              "the table has the kernels of these laws, in this order");

const KernelTable<Number> BILLET_KERNEL_TABLE = {
    n_lanes,
    {{{advance_assumed_strain<Hencky, false>, advance_assumed_strain<Hencky, true>},
      {advance_assumed_strain<NeoHookean, false>, advance_assumed_strain<NeoHookean, true>},
      {advance_assumed_strain<Hypoelastic, false>, advance_assumed_strain<Hypoelastic, true>}},
     {{advance_eight_point<Hencky, false>, advance_eight_point<Hencky, true>},
      {advance_eight_point<NeoHookean, false>, advance_eight_point<NeoHookean, true>},
      {advance_eight_point<Hypoelastic, false>, advance_eight_point<Hypoelastic, true>}},
     {{advance_one_point<Hencky, false>, advance_one_point<Hencky, true>},
      {advance_one_point<NeoHookean, false>, advance_one_point<NeoHookean, true>},
      {advance_one_point<Hypoelastic, false>, advance_one_point<Hypoelastic, true>}}}};

} // namespace billet::explicit_kernels
