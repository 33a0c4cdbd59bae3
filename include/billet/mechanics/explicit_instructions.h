// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_INSTRUCTIONS_H
#define BILLET_MECHANICS_EXPLICIT_INSTRUCTIONS_H

#include "billet/mechanics/explicit/kernel.h"
#include "billet/mechanics/explicit_block.h"

#include <stdexcept>

namespace billet {

/// Returns the kernels. Throws std::invalid_argument if they were not compiled or this processor
/// cannot run them.
template <class Number>
const explicit_kernels::KernelTable<Number> &find_kernels(InstructionSet instructions);
template <> const explicit_kernels::KernelTable<double> &find_kernels<double>(InstructionSet instructions);
template <> const explicit_kernels::KernelTable<float> &find_kernels<float>(InstructionSet instructions);

} // namespace billet

#endif
