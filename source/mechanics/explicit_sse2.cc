// SPDX-License-Identifier: LGPL-2.1-or-later
// Two elements at a time.
#define BILLET_LANES 2
#define BILLET_SINGLE 0
#define BILLET_KERNEL_TABLE sse2_kernels
#include "billet/mechanics/explicit/table.h"
