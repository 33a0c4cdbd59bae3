// SPDX-License-Identifier: LGPL-2.1-or-later
// Which kernels were compiled (CMake says so), and which of them this processor can run.
#include "billet/mechanics/explicit_instructions.h"

namespace billet {

namespace {

using explicit_kernels::KernelTable;

/// Null where it was not compiled or the processor cannot run it.
const KernelTable *find(const InstructionSet instructions) {
  switch (instructions) {
  case InstructionSet::automatic:
    return find(best_instruction_set());
  case InstructionSet::scalar:
    return &explicit_kernels::scalar_kernels;
  case InstructionSet::sse2:
#ifdef BILLET_KERNELS_SSE2
    if (__builtin_cpu_supports("sse2"))
      return &explicit_kernels::sse2_kernels;
#endif
    return nullptr;
  case InstructionSet::avx2:
#ifdef BILLET_KERNELS_AVX2
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      return &explicit_kernels::avx2_kernels;
#endif
    return nullptr;
  case InstructionSet::avx512:
#ifdef BILLET_KERNELS_AVX512
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma"))
      return &explicit_kernels::avx512_kernels;
#endif
    return nullptr;
  }
  return nullptr;
}

} // namespace

InstructionSet best_instruction_set() {
  for (const auto instructions : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::sse2})
    if (is_available(instructions))
      return instructions;
  return InstructionSet::scalar;
}

bool is_available(const InstructionSet instructions) { return find(instructions) != nullptr; }

const explicit_kernels::KernelTable &find_kernels(const InstructionSet instructions) {
  const KernelTable *table = find(instructions);
  if (table == nullptr)
    throw std::invalid_argument(
        "the instruction set is not available: this processor does not have it, or the "
        "program was compiled without it");
  return *table;
}

} // namespace billet
