// SPDX-License-Identifier: LGPL-2.1-or-later
// One element at a time, for every processor.
#define BILLET_LANES 1
#define BILLET_SINGLE 0
#define BILLET_KERNEL_TABLE scalar_kernels
#include "billet/mechanics/explicit/table.h"
