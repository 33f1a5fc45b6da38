// SPDX-License-Identifier: MIT
// Kernels: loops compiled once per instruction set, of which the program takes the best that the
// processor has when it runs.
//
// How to write one, in atmosphere/ or lut/:
//  1. name.h declares a table of function pointers and its choice:
//       struct LightKernel { void (*scatter)(const LightConstants&, float* light); };
//       ALPENGLOW_DECLARE_KERNEL(LightKernel);
//     Arguments are plain data: arrays, pointers, aggregates; no class with functions of its own.
//  2. name_kernel.cpp includes atmosphere/ray/batch.h, keeps all of its functions in an unnamed
//     namespace inside alpenglow, and ends with
//       const LightKernel& KernelOf(KernelName<LightKernel, kThisSet>) {
//         static constexpr LightKernel kernel{Scatter};
//         return kernel;
//       }
//  3. CMakeLists.txt: alpenglow_kernels(alpenglow_lut name_kernel.cpp)
//  4. Callers: Kernel<LightKernel>().scatter(...)
//
// A kernel is linked several times into one program. Whatever is not in the unnamed namespace (an
// inline function of a header that the compiler did not inline) becomes one weak symbol for the
// whole program, perhaps with instructions that the processor lacks; the tests kernel_symbols.*
// refuse objects with such symbols.
#pragma once

#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

/// Scalar kernels compute with one number at a time, so that tests can compare the others with them.
/// Baseline is what the compiler assumes of every processor: SSE2 on x86-64, NEON on AArch64; where
/// xsimd knows no such instructions, it is scalar too.
enum class InstructionSet { kScalar, kBaseline, kAvx2, kAvx512 };

/// "scalar"; "sse2", "neon" or, on other processors, "baseline"; "avx2", "avx512".
[[nodiscard]] std::string_view NameOf(InstructionSet set);

/// The sets that this program was built for and this
/// processor and its operating system have, ascending.
[[nodiscard]] const std::vector<InstructionSet>& AvailableInstructionSets();

/// The set that kernels use: the last available one, or the one that the environment variable
/// ALPENGLOW_INSTRUCTION_SET names. Throws InputError when that is not available.
[[nodiscard]] InstructionSet CurrentInstructionSet();

/// Makes the whole program use another available set while the object lives, so that sets can be
/// held against each other. Samples made under one set are not to be read under another.
class InstructionSetScope {
 public:
  /// Throws InputError when the set is not available.
  explicit InstructionSetScope(InstructionSet set);
  ~InstructionSetScope();
  InstructionSetScope(const InstructionSetScope&) = delete;
  InstructionSetScope& operator=(const InstructionSetScope&) = delete;

 private:
  InstructionSet before_;
};

/// Names the table of one set in overloads of KernelOf, which the file of the kernel defines.
template <typename Table, InstructionSet set>
struct KernelName {};

#ifdef ALPENGLOW_X86_KERNELS
#define ALPENGLOW_DECLARE_KERNEL(Table)                                                   \
  [[nodiscard]] const Table& KernelOf(KernelName<Table, InstructionSet::kScalar> name);   \
  [[nodiscard]] const Table& KernelOf(KernelName<Table, InstructionSet::kBaseline> name); \
  [[nodiscard]] const Table& KernelOf(KernelName<Table, InstructionSet::kAvx2> name);     \
  [[nodiscard]] const Table& KernelOf(KernelName<Table, InstructionSet::kAvx512> name)
#else
#define ALPENGLOW_DECLARE_KERNEL(Table)                                                 \
  [[nodiscard]] const Table& KernelOf(KernelName<Table, InstructionSet::kScalar> name); \
  [[nodiscard]] const Table& KernelOf(KernelName<Table, InstructionSet::kBaseline> name)
#endif

/// The table of the current set.
template <typename Table>
[[nodiscard]] const Table& Kernel() {
  switch (CurrentInstructionSet()) {
#ifdef ALPENGLOW_X86_KERNELS
    case InstructionSet::kAvx512:
      return KernelOf(KernelName<Table, InstructionSet::kAvx512>{});
    case InstructionSet::kAvx2:
      return KernelOf(KernelName<Table, InstructionSet::kAvx2>{});
#endif
    case InstructionSet::kScalar:
      return KernelOf(KernelName<Table, InstructionSet::kScalar>{});
    default:
      break;
  }
  return KernelOf(KernelName<Table, InstructionSet::kBaseline>{});
}

}  // namespace alpenglow::atmosphere
