// SPDX-License-Identifier: LGPL-2.1-or-later
// Sixteen elements in float at a time; needs AVX-512 F, DQ and VL, and FMA.
#define BILLET_LANES 16
#define BILLET_SINGLE 1
#define BILLET_KERNEL_TABLE avx512_float_kernels
#include "billet/mechanics/explicit/table.h"
