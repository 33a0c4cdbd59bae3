// SPDX-License-Identifier: LGPL-2.1-or-later
// One element at a time in float, for every processor.
#define BILLET_LANES 1
#define BILLET_SINGLE 1
#define BILLET_KERNEL_TABLE scalar_float_kernels
#include "billet/mechanics/explicit/table.h"
