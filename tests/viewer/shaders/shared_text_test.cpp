// SPDX-License-Identifier: MIT
// The reading of the shared texts on the graphics card, against the one in C++ float.
#include <gtest/gtest.h>

#include <cstddef>

#include "tests/fixtures/shared_text_cases.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

using SharedText = tests::Headless;

// Hard case 9.
TEST_F(SharedText, GpuAgreesWithFloatToOnePartInAHundredThousand) {
  for (const tests::SharedTextCase& c : tests::AllSharedTextCases()) {
    SCOPED_TRACE(c.glsl);
    const std::vector<float> on_gpu = tests::EvaluateOnGpu(SharedTexts(), c.glsl, c.points);
    for (std::size_t i = 0; i < c.points.size(); ++i) {
      ASSERT_NEAR(static_cast<double>(on_gpu[i]), static_cast<double>(c.in_float(c.points[i])),
                  tests::Allowance(c, c.points[i]))
          << "at " << ::testing::PrintToString(c.points[i])
          << "; allowed are 1e-5 and what one ulp of the arguments changes";
    }
  }
}

TEST_F(SharedText, AMessageOfTheDriverNamesOurFileAndLine) {
  std::vector<ShaderPiece> pieces = SharedTexts();
  pieces.push_back({"viewer/broken.glsl", "void main() {\n  gl_Position = nonsense;\n}\n"});
  try {
    ShaderProgram::ForTransformFeedback(pieces, {});
    FAIL() << "a broken shader was accepted";
  } catch (const InternalError& error) {
    EXPECT_NE(std::string(error.what()).find("viewer/broken.glsl:2"), std::string::npos)
        << error.what();
  }
}

TEST(ShaderText, LinesOfPiecesBecomeNamesAndLinesInTheLogsOfThreeDrivers) {
  const std::vector<ShaderPiece> pieces{{"a.glsl", ""}, {"b.glsl", ""}};
  EXPECT_EQ(NamePieces("0:100012(5): error: x\n0:3(1): error: y", pieces),
            "b.glsl:12: error: x\na.glsl:3: error: y");
  EXPECT_EQ(NamePieces("0(100012) : error C1008", pieces), "b.glsl:12 : error C1008");
  EXPECT_EQ(NamePieces("ERROR: 0:100012: 'x'", pieces), "ERROR: b.glsl:12: 'x'");
  EXPECT_EQ(NamePieces("0:700012(5): z", pieces), "0:700012(5): z")
      << "no such piece: left as it is";
}

TEST(ShaderText, EveryPieceHasLinesOfItsOwn) {
  const std::vector<ShaderPiece> pieces{{"a.glsl", "float a;"}, {"b.glsl", "float b;"}};
  EXPECT_EQ(ComposeShader(pieces),
            "#version 330 core\n#line 1\nfloat a;\n#line 100001\nfloat b;\n");
}

}  // namespace
}  // namespace alpenglow::viewer
