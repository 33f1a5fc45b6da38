// SPDX-License-Identifier: MIT
#include "viewer/async/latest_job.h"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>
#include <vector>

namespace alpenglow::viewer {
namespace {

TEST(LatestJob, WhatWasAskedForBeforeTheNewestIsNotMade) {
  std::promise<void> begun, go_on;
  std::vector<int> made;
  LatestJob<int, int> job([&](const int& number) {
    if (number == 1) {
      begun.set_value();
      go_on.get_future().wait();
    }
    made.push_back(number);
    return 10 * number;
  });
  job.Ask(1);
  begun.get_future().wait();
  job.Ask(2);
  job.Ask(3);
  EXPECT_TRUE(job.Busy());
  go_on.set_value();
  job.Wait();
  EXPECT_EQ(job.Take(), std::optional(30));
  EXPECT_EQ(job.Take(), std::nullopt) << "a result is taken once";
  EXPECT_EQ(made, (std::vector{1, 3}));
}

TEST(LatestJob, WhatTheWorkThrowsIsThrownToWhoAsks) {
  LatestJob<int, int> job([](const int& number) {
    if (number == 1) throw std::runtime_error("no air");
    return number;
  });
  job.Ask(1);
  job.Wait();
  EXPECT_THROW(static_cast<void>(job.Take()), std::runtime_error);
  job.Ask(2);
  job.Wait();
  EXPECT_EQ(job.Take(), std::optional(2)) << "the next request finds a working thread";
}

TEST(LatestJob, EndsWithARequestWaiting) {
  LatestJob<int, int> job([](const int& number) { return number; });
  job.Ask(1);
  SUCCEED() << "the destructor returns";
}

}  // namespace
}  // namespace alpenglow::viewer
