// SPDX-License-Identifier: MIT
#include "atmosphere/shared_glsl/instruction_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"

namespace alpenglow::atmosphere {
namespace {

#if defined(__SSE2__)
constexpr char kBaselineName[] = "sse2";
#elif defined(__ARM_NEON)
constexpr char kBaselineName[] = "neon";
#else
constexpr char kBaselineName[] = "baseline";
#endif

constexpr EnumNames kNames{{std::pair{InstructionSet::kScalar, "scalar"},
                            {InstructionSet::kBaseline, kBaselineName},
                            {InstructionSet::kAvx2, "avx2"},
                            {InstructionSet::kAvx512, "avx512"}}};

std::vector<InstructionSet> FindAvailable() {
  std::vector<InstructionSet> sets{InstructionSet::kScalar, InstructionSet::kBaseline};
#ifdef ALPENGLOW_X86_KERNELS
  // The compiler's test also checks that the operating system saves the wide registers.
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  if (avx2) sets.push_back(InstructionSet::kAvx2);
  if (avx2 && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512cd") != 0 &&
      __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
      __builtin_cpu_supports("avx512vl") != 0) {
    sets.push_back(InstructionSet::kAvx512);
  }
#endif
  return sets;
}

std::string NamesOfAvailable() {
  std::string names;
  for (const InstructionSet set : AvailableInstructionSets()) {
    names += names.empty() ? "" : ", ";
    names += NameOf(set);
  }
  return names;
}

InstructionSet Named(std::string_view name) {
  for (const InstructionSet set : AvailableInstructionSets()) {
    if (NameOf(set) == name) return set;
  }
  throw InputError(
      fmt::format("ALPENGLOW_INSTRUCTION_SET is \"{}\"; this program and processor have {}", name,
                  NamesOfAvailable()));
}

InstructionSet FirstChoice() {
  const char* const name = std::getenv("ALPENGLOW_INSTRUCTION_SET");
  const bool unset = name == nullptr || *name == '\0';  // a shell can only clear it
  return unset ? AvailableInstructionSets().back() : Named(name);
}

std::atomic<InstructionSet>& Current() {
  static std::atomic<InstructionSet> current{FirstChoice()};
  return current;
}

}  // namespace

std::string_view NameOf(InstructionSet set) { return kNames.Of(set); }

const std::vector<InstructionSet>& AvailableInstructionSets() {
  static const std::vector<InstructionSet> sets = FindAvailable();
  return sets;
}

InstructionSet CurrentInstructionSet() { return Current().load(std::memory_order_relaxed); }

InstructionSetScope::InstructionSetScope(InstructionSet set) : before_(CurrentInstructionSet()) {
  const auto& sets = AvailableInstructionSets();
  if (std::find(sets.begin(), sets.end(), set) == sets.end()) {
    throw InputError(
        fmt::format("instruction set {} is not available; this program and processor have {}",
                    NameOf(set), NamesOfAvailable()));
  }
  Current().store(set);
}

InstructionSetScope::~InstructionSetScope() { Current().store(before_); }

}  // namespace alpenglow::atmosphere
