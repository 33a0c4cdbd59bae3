// SPDX-License-Identifier: LGPL-2.1-or-later
// No include guard: one file for each instruction set and number type includes this once. It first defines
// BILLET_LANES, BILLET_SINGLE and BILLET_KERNEL_TABLE (the name of its table in kernel.h).
#include "billet/mechanics/explicit/assumed_strain.h"
#include "billet/mechanics/explicit/eight_point.h"
#include "billet/mechanics/explicit/one_point.h"

namespace billet::explicit_kernels {

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
