// SPDX-License-Identifier: MIT
// Kernels: loops that are compiled once per instruction set. At run time the program selects the
// best version that the processor supports.
//
// How to write one, in atmosphere/ or lut/:
//  1. name.h declares a table of function pointers and its choice:
//       struct LightKernel { void (*scatter)(const LightConstants&, float* light); };
//       ALPENGLOW_DECLARE_KERNEL(LightKernel);
//     Arguments are plain data: arrays, pointers, aggregates; no class with member functions.
//  2. name_kernel.cpp includes atmosphere/ray/batch.h, keeps all of its functions in an unnamed
//     namespace inside alpenglow, and ends with
//       const LightKernel& KernelOf(KernelName<LightKernel, kThisSet>) {
//         static constexpr LightKernel kernel{Scatter};
//         return kernel;
//       }
//  3. CMakeLists.txt: alpenglow_kernels(alpenglow_lut name_kernel.cpp)
//  4. Callers: Kernel<LightKernel>().scatter(...)
//
// A kernel is linked several times into one program. A function outside the unnamed namespace (an
// inline function of a header that the compiler did not inline) becomes one weak symbol for the
// whole program, possibly with instructions that the processor lacks. The tests kernel_symbols.*
// reject objects with such symbols.
#pragma once

#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

/// Scalar kernels compute with one number at a time, as a reference for the others in tests.
/// Baseline is the instruction set that the compiler assumes of every processor: SSE2 on x86-64,
/// NEON on AArch64; on processors without support in xsimd it is scalar too.
enum class InstructionSet { kScalar, kBaseline, kAvx2, kAvx512 };

/// Returns "scalar"; "sse2", "neon" or, on other processors, "baseline"; "avx2", "avx512".
[[nodiscard]] std::string_view NameOf(InstructionSet set);

/// Returns the sets that this program was built for and that this processor and its operating
/// system support, ascending.
[[nodiscard]] const std::vector<InstructionSet>& AvailableInstructionSets();

/// Returns the set that kernels use: the last available one, or the one named in the environment
/// variable ALPENGLOW_INSTRUCTION_SET. Throws InputError if that set is not available.
[[nodiscard]] InstructionSet CurrentInstructionSet();

/// Makes the whole program use another available set during the lifetime of the object, to compare
/// sets. Samples made with one set must not be read with another.
class InstructionSetScope {
 public:
  /// Throws InputError if the set is not available.
  explicit InstructionSetScope(InstructionSet set);
  ~InstructionSetScope();
  InstructionSetScope(const InstructionSetScope&) = delete;
  InstructionSetScope& operator=(const InstructionSetScope&) = delete;

 private:
  InstructionSet before_;
};

/// Names the table of one set in overloads of KernelOf, which the source file of the kernel
/// defines.
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

/// Returns the table of the current set.
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
