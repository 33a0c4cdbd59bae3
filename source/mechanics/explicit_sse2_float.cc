// SPDX-License-Identifier: LGPL-2.1-or-later
// Four elements in float at a time.
#define BILLET_LANES 4
#define BILLET_SINGLE 1
#define BILLET_KERNEL_TABLE sse2_float_kernels
#include "billet/mechanics/explicit/table.h"
