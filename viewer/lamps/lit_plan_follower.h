// SPDX-License-Identifier: MIT
// The LitPlans of lamps, made one by one beside drawing, once.
#pragma once

#include <functional>
#include <vector>

#include "viewer/job/latest_job.h"
#include "viewer/lamps/lit_plan.h"

namespace alpenglow::viewer {

class LitPlanFollower {
 public:
  /// Of a lamp by its number, from 0.
  using Make = std::function<LitPlan(std::size_t)>;
  /// @param make  called on a thread of this; what it refers to must outlive this.
  LitPlanFollower(std::size_t lamps, Make make) : lamps_(lamps), job_(std::move(make)) {}

  /// Takes in what is finished and asks for the next.
  void Follow();
  /// Waits for all of them.
  void Settle();
  /// Of the first lamps, as many as are finished.
  [[nodiscard]] const std::vector<LitPlan>& plans() const { return plans_; }

 private:
  std::size_t lamps_;
  std::vector<LitPlan> plans_;
  LatestJob<std::size_t, LitPlan> job_;
};

}  // namespace alpenglow::viewer
