// SPDX-License-Identifier: MIT
#include "lut/table_search/table_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "atmosphere/base/error.h"
#include "lut/table_search/table_views.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

const MultipleScattering& Small() {
  static const MultipleScattering light(MediumPreset("bruneton2017"), {.altitudes = 9,
                                                                       .sun_angles = 13,
                                                                       .degree = 4,
                                                                       .zenith_nodes = 6,
                                                                       .azimuth_nodes = 4,
                                                                       .ray_nodes = 6});
  return light;
}

/// This solution is good enough to choose from, and quick: its own errors do not count.
const MultipleScattering& Quick() {
  static const MultipleScattering light(MediumPreset("bruneton2017"), {});
  return light;
}

/// The finest solution of scalar light of the earth in one band; the usual one under the
/// sanitizers.
const MultipleScattering& EarthFinest() {
  static const MultipleScattering light = [] {
    const Medium medium = InScalarLight(MediumPreset("earth", {550.0}));
    return tests::kSanitized ? MultipleScattering(medium) : FinestMultipleScattering(medium);
  }();
  return light;
}

TEST(TableSearch, ResamplingKeepsSharedNodes) {
  const MultipleScattering half = Resampled(Small(), 5, 7, 2);
  EXPECT_EQ(half.values().size(), 5U * 7U * 7U * 3U) << "six moments and the irradiance";
  const double v = 4.0 / 12.0;  // the fifth of 13 nodes, the third of 7
  const std::vector<float> before = Small().ValuesAt(0.25, v), after = half.ValuesAt(0.25, v);
  for (std::size_t i = 0; i < 18; ++i) EXPECT_NEAR(after[i], before[i], 1e-6F) << i;
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(after[18 + band], before[45 + band], 1e-6F) << "irradiance comes last";
  }
  EXPECT_THROW(static_cast<void>(Resampled(Small(), 5, 7, 6)), InternalError) << "it has degree 4";
}

TEST(TableSearch, ChoosesNoDegreeBeyondTheFinestSolution) {
  const TableChoice choice = ChooseTables(
      Small(), {.max_error = 0.5, .views_of_a_kind = 4, .path_traced_views_of_a_kind = 0});
  EXPECT_LE(choice.tables.multiple_scattering->options().degree, Small().options().degree);
  for (const float value : choice.tables.multiple_scattering->values())
    ASSERT_TRUE(std::isfinite(value));
}

TEST(TableSearch, UnreachableErrorsAreRefusedWithTheBestOne) {
  EXPECT_THAT(tests::FaultOf([] {
                return ChooseTables(
                    Quick(),
                    {.max_error = 1e-5, .views_of_a_kind = 8, .path_traced_views_of_a_kind = 0});
              }),
              testing::AllOf(testing::HasSubstr("max-error 0.001 %"),
                             testing::HasSubstr("nodes along a ray leave")))
      << "tables of floats on a grid do not reach 0.001 %";
  EXPECT_THROW(static_cast<void>(ChooseTables(Small(), {.max_error = 0.0})), InputError);
}

/// Other views than those that the search saw are under the bound, too. They are compared with the
/// reference solution and, few of them, with paths.
class ChosenTables : public TemporaryFolder {
 protected:
  static constexpr double kMaxError = tests::ScaledDown(0.02, 0.1);
  static constexpr std::size_t kViews = tests::ScaledDown<std::size_t>(80, 18);
  static constexpr std::size_t kUnseen = 100000;
  /// An rms may have this share of the bound: 80 views tell it to a twelfth, 18 to a sixth.
  static constexpr double kSampling = 1.0 + tests::ScaledDown(1.0 / 12.0, 1.0 / 6.0);

  static TableChoice Chosen(TablesWanted wanted, std::size_t path_traced) {
    return ChooseTables(EarthFinest(), {.max_error = kMaxError,
                                        .views_of_a_kind = kViews,
                                        .path_traced_views_of_a_kind = path_traced,
                                        .wanted = wanted});
  }
  static const ReferenceViews& Unseen() {
    static const ReferenceViews views(EarthFinest().medium(), EarthFinest(), kViews, kUnseen);
    return views;
  }
};

TEST_F(ChosenTables, SmallestTablesKeepTheBoundOnUnseenViews) {
  const TableChoice choice = Chosen(TablesWanted::kSmallest, tests::ScaledDown<std::size_t>(2, 1));
  WriteTables(choice, folder_);
  const TableLookup stored(ReadTableFolder(folder_, MediumHash(EarthFinest().medium())));
  EXPECT_EQ(stored.tables().ray_nodes, choice.tables.ray_nodes);
  EXPECT_FALSE(fs::exists(folder_ / kSingleScatteringFileName));
  for (const TableChoice::Measured& measured : choice.measured) {
    EXPECT_LT(measured.errors.Rms(), kMaxError);
    EXPECT_LT(measured.paths.Unexplained(), kMaxError);
    const ErrorStatistics errors = Unseen().ErrorsOf(stored, measured.kind);
    EXPECT_LT(std::hypot(errors.Rms(), measured.paths.Unexplained()), kSampling * kMaxError)
        << NameOf(measured.kind) << ":\n"
        << ChoiceText(choice, kMaxError);
  }
}

TEST_F(ChosenTables, AllThreeTogetherKeepTheBoundOnUnseenViews) {
  const TableChoice choice = Chosen(TablesWanted::kAll, 0);
  WriteTables(choice, folder_);
  const TableLookup stored(ReadTableFolder(folder_));
  ASSERT_TRUE(stored.tables().transmittance && stored.tables().single_scattering);
  EXPECT_EQ(stored.tables().single_scattering->texels(), choice.tables.single_scattering->texels());
  for (const ViewKind kind : kViewKinds) {
    EXPECT_LT(Unseen().ErrorsOf(stored, kind).Rms(), kSampling * kMaxError)
        << NameOf(kind) << ":\n"
        << ChoiceText(choice, kMaxError);
  }
}

TEST(TableSearch, SmallerErrorsNeedMoreMemory) {
  const TableSearch coarse{.max_error = tests::ScaledDown(0.05, 0.3),
                           .views_of_a_kind = 16,
                           .path_traced_views_of_a_kind = 0};
  const TableSearch fine{.max_error = tests::ScaledDown(0.01, 0.1),
                         .views_of_a_kind = 16,
                         .path_traced_views_of_a_kind = 0};
  const TableChoice small = ChooseTables(Quick(), coarse), large = ChooseTables(Quick(), fine);
  EXPECT_LT(small.bytes, large.bytes);
  EXPECT_LE(small.tables.ray_nodes, large.tables.ray_nodes);
  EXPECT_EQ(ChooseTables(Quick(), coarse).tables.multiple_scattering->values(),
            small.tables.multiple_scattering->values())
      << "the same search finds the same tables";
}

}  // namespace
}  // namespace alpenglow::lut
