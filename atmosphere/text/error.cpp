// SPDX-License-Identifier: MIT
#include "atmosphere/text/error.h"

namespace alpenglow {

double RequireInRange(double value, double low, double high, std::string_view name) {
  if (!(value >= low && value <= high)) {  // written so that NaN fails
    throw InputError(fmt::format("{} is {}; it must lie in [{}, {}]", name, value, low, high));
  }
  return value;
}

}  // namespace alpenglow
