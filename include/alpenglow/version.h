// SPDX-License-Identifier: MIT
/// @file
/// The version of the library.
#pragma once

#include <string_view>

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// Returns the release of the linked library, such as "0.2.0" (Semantic Versioning).
[[nodiscard]] std::string_view Version();

}  // namespace alpenglow
