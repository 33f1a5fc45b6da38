// SPDX-License-Identifier: MIT
// Whether a test runs under the sanitizers, where what takes seconds takes minutes.
#pragma once

namespace alpenglow::tests {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace alpenglow::tests
