// SPDX-License-Identifier: MIT
#include "viewer/lamps/lit_plan_follower.h"

#include <utility>

namespace alpenglow::viewer {

void LitPlanFollower::Follow() {
  if (plans_.size() == lamps_ || job_.Busy()) return;
  if (std::optional<LitPlan> made = job_.Take()) plans_.push_back(std::move(*made));
  if (plans_.size() < lamps_) job_.Ask(plans_.size());
}

void LitPlanFollower::Settle() {
  for (Follow(); plans_.size() < lamps_; Follow()) job_.Wait();
}

}  // namespace alpenglow::viewer
