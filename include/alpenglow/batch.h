// SPDX-License-Identifier: MIT
/// @file
/// Arguments of batches, which compute many rays in one call, on all processors, into memory of the
/// caller.
///
/// Results lie one after the other: the bands of the first ray, those of the second one, and so on.
/// Their number says how many rays there are. A batch gives the same values as single calls.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// One value for all rays of a batch, or a value for each of them. It refers to the values, which
/// must live until the call returns.
template <typename Value>
class OneOrMany {
 public:
  /// Makes the argument from one value for all rays.
  OneOrMany(const Value& one) : values_(&one, 1) {}  // NOLINT: as arguments are written
  /// Makes the argument from a value for each ray.
  OneOrMany(std::span<const Value> many) : values_(many) {}  // NOLINT: as above
  /// Makes the argument from a value for each ray.
  OneOrMany(const std::vector<Value>& many) : values_(many) {}  // NOLINT: as above

  /// Returns the number of values.
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  /// Returns the value of a ray, which must exist: this is not checked.
  [[nodiscard]] const Value& operator[](std::size_t ray) const {
    return values_[values_.size() == 1 ? 0 : ray];
  }

 private:
  std::span<const Value> values_;
};

}  // namespace alpenglow
