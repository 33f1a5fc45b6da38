// SPDX-License-Identifier: MIT
// The check of results that leave the library or a program. Bad input is refused where it is read;
// a result that is not finite is therefore a fault of the library.
#pragma once

#include <span>
#include <string_view>

namespace alpenglow::atmosphere {

/// Throws InternalError naming `what` if a value is NaN or infinite.
void RequireFinite(std::span<const float> values, std::string_view what);
void RequireFinite(std::span<const double> values, std::string_view what);

}  // namespace alpenglow::atmosphere
