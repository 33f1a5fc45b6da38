// SPDX-License-Identifier: MIT
#include "atmosphere/base/async_value.h"
#include "viewer/layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <stdexcept>
#include <vector>

namespace alpenglow::viewer {
namespace {

TEST(AsyncValue, ARequestThatANewerOneReplacedIsNotComputed) {
  std::promise<void> begun, go_on;
  std::vector<int> made;
  AsyncValue<int, int> value([&](const int& number) {
    if (number == 1) {
      begun.set_value();
      go_on.get_future().wait();
    }
    made.push_back(number);
    return 10 * number;
  });
  value.Request(1);
  begun.get_future().wait();
  value.Request(2);
  value.Request(3);
  EXPECT_TRUE(value.IsBusy());
  go_on.set_value();
  value.Wait();
  EXPECT_EQ(value.Poll(), std::optional(30));
  EXPECT_EQ(value.Poll(), std::nullopt) << "a value is taken over once";
  EXPECT_EQ(made, (std::vector{1, 3}));
}

TEST(AsyncValue, ExceptionsReachTheCallerAndTheThreadGoesOn) {
  AsyncValue<int, int> value([](const int& number) {
    if (number == 1) throw std::runtime_error("no air");
    return number;
  });
  value.Request(1);
  value.Wait();
  EXPECT_THROW(static_cast<void>(value.Poll()), std::runtime_error);
  value.Request(2);
  value.Wait();
  EXPECT_EQ(value.Poll(), std::optional(2));
}

TEST(AsyncValue, EndsWithARequestWaiting) {
  AsyncValue<int, int> value([](const int& number) { return number; });
  value.Request(1);
  SUCCEED() << "the destructor returns";
}

TEST(AsyncValue, FollowsItsInputAccordingToThePolicy) {
  AsyncValue<double, double> value([](const double& input) { return 2.0 * input; },
                                   [](const double& requested, const double& wanted) {
                                     return std::abs(requested - wanted) < 0.5;
                                   });
  EXPECT_FALSE(value.Update());
  EXPECT_EQ(value.value(), std::nullopt);
  value.WaitUntilReady(1.0);
  EXPECT_TRUE(value.Update());
  EXPECT_FALSE(value.RequestIfNeeded(1.2)) << "the newest request suits";
  EXPECT_FALSE(value.Update());
  EXPECT_EQ(value.value(), std::optional(2.0));
  value.RestFor(1e6);
  value.RequestWhenIdle(3.0);
  EXPECT_EQ(value.requested(), std::optional(1.0)) << "it rests";
  value.WaitUntilReady(3.0);
  EXPECT_EQ(value.Poll(), std::optional(6.0)) << "who waits does not rest";
  value.Forget();
  value.RequestWhenIdle(3.0);
  value.Wait();
  EXPECT_EQ(value.Poll(), std::optional(6.0)) << "a forgotten request is made again";
}

}  // namespace
}  // namespace alpenglow::viewer
