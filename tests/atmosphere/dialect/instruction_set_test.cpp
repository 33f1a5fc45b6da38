// SPDX-License-Identifier: MIT
// Whatever instruction set the processor has, the light is the same.
#include "atmosphere/dialect/instruction_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/text/error.h"

namespace alpenglow {
namespace {

template <typename Real>
std::vector<double> LightOfManyRays() {
  const AirIntegrator<Real> air(MediumPreset("earth"));
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

template <typename Real>
void ExpectTheSameLightFromEverySet(double bound) {
  const std::vector<double> expected = [] {
    const InstructionSetScope baseline(InstructionSet::kBaseline);
    return LightOfManyRays<Real>();
  }();
  for (const InstructionSet set : AvailableInstructionSets()) {
    const InstructionSetScope scope(set);
    const std::vector<double> light = LightOfManyRays<Real>();
    ASSERT_EQ(light.size(), expected.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
      EXPECT_NEAR(light[i], expected[i], bound * expected[i] + 1e-13)
          << NameOf(set) << ": fused operations and the order of sums change the rounding only";
    }
  }
}

TEST(InstructionSet, EveryAvailableSetGivesTheSameLightInFloat) {
  ExpectTheSameLightFromEverySet<float>(2e-5);
}

TEST(InstructionSet, EveryAvailableSetGivesTheSameLightInDouble) {
  ExpectTheSameLightFromEverySet<double>(1e-11);
}

TEST(InstructionSet, TheBestAvailableOneIsUsedUnlessTheEnvironmentNamesAnother) {
  const auto& sets = AvailableInstructionSets();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets.front(), InstructionSet::kBaseline);
  const char* const forced = std::getenv("ALPENGLOW_INSTRUCTION_SET");
  EXPECT_EQ(NameOf(CurrentInstructionSet()), forced == nullptr || *forced == '\0'
                                                 ? std::string(NameOf(sets.back()))
                                                 : std::string(forced));
}

TEST(InstructionSet, AScopeEndsWithTheSetBeforeIt) {
  const InstructionSet before = CurrentInstructionSet();
  {
    const InstructionSetScope scope(InstructionSet::kBaseline);
    EXPECT_EQ(CurrentInstructionSet(), InstructionSet::kBaseline);
  }
  EXPECT_EQ(CurrentInstructionSet(), before);
}

TEST(InstructionSetDeathTest, AnUnknownNameInTheEnvironmentIsRefused) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        setenv("ALPENGLOW_INSTRUCTION_SET", "mmx", 1);
        try {
          static_cast<void>(CurrentInstructionSet());
        } catch (const InputError& error) {
          std::fprintf(stderr, "%s\n", error.what());
          std::exit(3);
        }
      },
      ::testing::ExitedWithCode(3), "ALPENGLOW_INSTRUCTION_SET is \"mmx\"; .* have");
}

TEST(InstructionSetDeathTest, AnEmptyNameInTheEnvironmentIsAsIfItWereUnset) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        setenv("ALPENGLOW_INSTRUCTION_SET", "", 1);
        std::exit(CurrentInstructionSet() == AvailableInstructionSets().back() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace alpenglow
