// SPDX-License-Identifier: LGPL-2.1-or-later
// Selection of kernels: those that were compiled (set by CMake) and that this processor can run.
#include "billet/mechanics/explicit_instructions.h"

namespace billet {

namespace {

using explicit_kernels::KernelTable;

/// Kernels of an instruction set for both number types.
struct Tables {
  const KernelTable<double> *in_double = nullptr;
  const KernelTable<float> *in_float = nullptr;
};

/// Returns null pointers if it was not compiled or the processor cannot run it.
Tables find(const InstructionSet instructions) {
  using namespace explicit_kernels;
  switch (instructions) {
  case InstructionSet::automatic:
    return find(best_instruction_set());
  case InstructionSet::scalar:
    return {&scalar_kernels, &scalar_float_kernels};
  case InstructionSet::sse2:
#ifdef BILLET_KERNELS_SSE2
    if (__builtin_cpu_supports("sse2"))
      return {&sse2_kernels, &sse2_float_kernels};
#endif
    return {};
  case InstructionSet::avx2:
#ifdef BILLET_KERNELS_AVX2
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      return {&avx2_kernels, &avx2_float_kernels};
#endif
    return {};
  case InstructionSet::avx512:
#ifdef BILLET_KERNELS_AVX512
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma"))
      return {&avx512_kernels, &avx512_float_kernels};
#endif
    return {};
  }
  return {};
}

Tables require_support(const InstructionSet instructions) {
  const Tables tables = find(instructions);
  if (tables.in_double == nullptr)
    throw std::invalid_argument(
        "the instruction set is not available: the processor or the compiled program lacks it");
  return tables;
}

} // namespace

InstructionSet best_instruction_set() {
  for (const auto instructions : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::sse2})
    if (is_available(instructions))
      return instructions;
  return InstructionSet::scalar;
}

bool is_available(const InstructionSet instructions) { return find(instructions).in_double != nullptr; }

template <> const KernelTable<double> &find_kernels<double>(const InstructionSet instructions) {
  return *require_support(instructions).in_double;
}

template <> const KernelTable<float> &find_kernels<float>(const InstructionSet instructions) {
  return *require_support(instructions).in_float;
}

} // namespace billet
