// SPDX-License-Identifier: MIT
// The light is the same with every instruction set that the processor has.
#include "atmosphere/shared_glsl/instruction_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/ray/ray_kernel.h"
#include "atmosphere/ray/single_scattering.h"

namespace alpenglow::atmosphere {
namespace {

template <typename Real>
std::vector<double> LightOfManyRays() {
  const SingleScattering<Real> air(MediumPreset("earth"));
  std::vector<double> light;
  for (const double altitude : {2.0, 10e3, 400e3}) {
    for (const double view : {10.0, 60.0, 89.0, 95.0, 110.0, 170.0}) {
      for (const double sun : {10.0, 60.0, 85.0, 92.0}) {
        const ViewRay ray = RayFromAngles(altitude, view, 40.0, sun);
        const auto radiance = air.Inscatter(air.Scatter(air.Sample(ray, {})), ray.nu);
        const auto transmittance = air.TransmittanceAlong(ray);
        for (std::size_t band = 0; band < air.bands(); ++band) {
          light.push_back(static_cast<double>(radiance[band]));
          light.push_back(static_cast<double>(transmittance[band]));
        }
      }
    }
  }
  return light;
}

// Fused operations, the order of sums and the exponential of xsimd change the rounding only. Light
// of less than 1e-13 counts as none, so an optical depth is at most 30: the exponential turns its
// rounding of a unit in the last place into one of 30 units, and sums add one or two.
template <typename Real>
void ExpectTheScalarLightFromEverySet() {
  const double bound = 32.0 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  const std::vector<double> expected = [] {
    const InstructionSetScope scalar(InstructionSet::kScalar);
    return LightOfManyRays<Real>();
  }();
  for (const InstructionSet set : AvailableInstructionSets()) {
    const InstructionSetScope scope(set);
    const std::vector<double> light = LightOfManyRays<Real>();
    ASSERT_EQ(light.size(), expected.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
      EXPECT_NEAR(light[i], expected[i], bound * expected[i] + 1e-13) << NameOf(set);
    }
  }
}

TEST(InstructionSet, EveryAvailableSetGivesTheScalarLight) {
  ExpectTheScalarLightFromEverySet<float>();
  ExpectTheScalarLightFromEverySet<double>();
}

TEST(InstructionSet, ScalarSetUsesOneNumberAtATime) {
  const InstructionSetScope scalar(InstructionSet::kScalar);
  EXPECT_EQ(Kernel<RayKernel<float>>().lanes, 1U);
  EXPECT_EQ(Kernel<RayKernel<double>>().lanes, 1U);
}

TEST(InstructionSet, BestSetIsUsedUnlessTheEnvironmentNamesAnother) {
  const auto& sets = AvailableInstructionSets();
  ASSERT_GE(sets.size(), 2U);
  EXPECT_EQ(sets.front(), InstructionSet::kScalar);
  const char* const forced = std::getenv("ALPENGLOW_INSTRUCTION_SET");
  EXPECT_EQ(NameOf(CurrentInstructionSet()), forced == nullptr || *forced == '\0'
                                                 ? std::string(NameOf(sets.back()))
                                                 : std::string(forced));
}

TEST(InstructionSet, AScopeRestoresTheEarlierSet) {
  const InstructionSet before = CurrentInstructionSet();
  {
    const InstructionSetScope scope(InstructionSet::kBaseline);
    EXPECT_EQ(CurrentInstructionSet(), InstructionSet::kBaseline);
  }
  EXPECT_EQ(CurrentInstructionSet(), before);
}

// Ends the program with 0 where the name in the environment chooses the set, and with 3 where it is
// refused.
[[noreturn]] void ChooseByName(const std::string& name, InstructionSet expected) {
  setenv("ALPENGLOW_INSTRUCTION_SET", name.c_str(), 1);
  try {
    std::exit(CurrentInstructionSet() == expected ? 0 : 1);
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::exit(3);
  }
}

TEST(InstructionSetDeathTest, EnvironmentCanSelectEveryAvailableSet) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  for (const InstructionSet set : AvailableInstructionSets()) {
    EXPECT_EXIT(ChooseByName(std::string(NameOf(set)), set), ::testing::ExitedWithCode(0), "")
        << NameOf(set);
  }
  EXPECT_EXIT(ChooseByName("", AvailableInstructionSets().back()), ::testing::ExitedWithCode(0), "")
      << "an empty name is none";
}

TEST(InstructionSetDeathTest, AnUnknownNameInTheEnvironmentIsRefused) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  for (const std::string name : {"mmx", "Scalar", "scalar ", "avx"}) {
    EXPECT_EXIT(ChooseByName(name, InstructionSet::kScalar), ::testing::ExitedWithCode(3),
                "ALPENGLOW_INSTRUCTION_SET is \"" + name + "\"; .* have scalar, ");
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
