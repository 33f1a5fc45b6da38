// SPDX-License-Identifier: MIT
#include "viewer/gl/pass_timer.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/viewer/shaders/headless.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {
namespace {

using ::testing::ElementsAre;

class PassTimers : public tests::Headless {
 protected:
  static std::vector<std::string> NamesOf(const std::vector<PassTime>& times) {
    std::vector<std::string> names;
    for (const PassTime& time : times) names.push_back(time.pass);
    return names;
  }
};

/// A picture whose every pixel is so many sines of sines.
class Work {
 public:
  explicit Work(int sines)
      : program_({{"vertex",
                   "void main() { vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);\n"
                   "gl_Position = vec4(2.0 * p - 1.0, 0.0, 1.0); }"}},
                 {{"fragment",
                   "out vec4 colour; void main() { float s = gl_FragCoord.x;\n"
                   "for (int i = 0; i < " +
                       std::to_string(sines) +
                       "; ++i) s = sin(s + gl_FragCoord.y);\ncolour = vec4(s); }"}}) {
    Draw();
    glFinish();
  }
  void Draw() const {
    target_.Bind();
    glBindVertexArray(none_.id());
    program_.Use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  RenderTarget target_{128, 128, RenderTarget::Depth::kNone};
  GlVertexArray none_;
  ShaderProgram program_;
};

TEST_F(PassTimers, OfTwoPassesTheOneWithMoreWorkTakesLonger) {
  const Work light(1), heavy(400);
  for (const PassClock clock : {PassClock::kFinishes, PassClock::kQueries}) {
    PassTimer timer(clock);
    double least_light = 1e9, least_heavy = 1e9;
    for (int i = 0; i < 5; ++i) {
      timer.Begin("light");
      light.Draw();
      timer.Begin("heavy");  // ends the other
      heavy.Draw();
      const std::vector<PassTime> times = timer.TakeAll();
      ASSERT_THAT(NamesOf(times), ElementsAre("light", "heavy"));
      EXPECT_GE(times[1].cpu_ms, 0.0);
      least_light = std::min(least_light, times[0].ms);
      least_heavy = std::min(least_heavy, times[1].ms);
    }
    EXPECT_GT(least_heavy, least_light) << "400 times the sines; the least of five, whatever else "
                                           "the machine does";
  }
}

TEST_F(PassTimers, WithoutAClockNothingIsTimed) {
  const Work work(1);
  PassTimer timer;
  timer.Begin("work");
  work.Draw();
  EXPECT_TRUE(timer.TakeAll().empty());
}

TEST_F(PassTimers, ResultsThatNobodyTakesAreBounded) {
  PassTimer timer(PassClock::kQueries);
  for (int i = 0; i < 2000; ++i) timer.Begin("nothing");
  const std::size_t taken = timer.TakeAll().size();
  EXPECT_GT(taken, 100U);
  EXPECT_LT(taken, 1000U);
  timer.Begin("again");
  EXPECT_THAT(NamesOf(timer.TakeAll()), ElementsAre("again")) << "the queries are free again";
}

TEST_F(PassTimers, AnOpenPassIsNotTaken) {
  for (const PassClock clock : {PassClock::kFinishes, PassClock::kQueries}) {
    PassTimer timer(clock);
    timer.Begin("open");
    EXPECT_TRUE(timer.Take().empty());
    timer.End();
    glFinish();
    EXPECT_THAT(NamesOf(timer.Take()), ElementsAre("open"));
  }
}

}  // namespace
}  // namespace alpenglow::viewer
