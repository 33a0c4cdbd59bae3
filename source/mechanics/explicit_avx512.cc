// SPDX-License-Identifier: LGPL-2.1-or-later
// Eight elements at a time; needs AVX-512 F, DQ and VL, and FMA.
#define BILLET_LANES 8
#define BILLET_SINGLE 0
#define BILLET_KERNEL_TABLE avx512_kernels
#include "billet/mechanics/explicit/table.h"
