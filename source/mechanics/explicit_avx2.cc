// SPDX-License-Identifier: LGPL-2.1-or-later
// Four elements at a time; needs AVX2 and FMA.
#define BILLET_LANES 4
#define BILLET_SINGLE 0
#define BILLET_KERNEL_TABLE avx2_kernels
#include "billet/mechanics/explicit/table.h"
