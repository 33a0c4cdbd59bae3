// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_KERNEL_CHOICE_H
#define BILLET_MECHANICS_KERNEL_CHOICE_H

namespace billet {

/// Instruction set of a kernel, for 1, 2, 4 or 8 elements at once, in float 1, 4, 8 or 16.
/// `automatic` is the widest that the processor supports.
enum class InstructionSet { automatic, scalar, sse2, avx2, avx512 };

/// Type of the numbers in element computations; nodal vectors and all sums are double.
enum class NumberType { double_precision, float_precision };

} // namespace billet

#endif
