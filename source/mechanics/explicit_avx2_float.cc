// SPDX-License-Identifier: LGPL-2.1-or-later
// Eight elements in float at a time; needs AVX2 and FMA.
#define BILLET_LANES 8
#define BILLET_SINGLE 1
#define BILLET_KERNEL_TABLE avx2_float_kernels
#include "billet/mechanics/explicit/table.h"
