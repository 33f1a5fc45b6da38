// SPDX-License-Identifier: MIT
// Closes what shared_begin.h opened.
#undef SHARED
#undef Number
#undef Length
#pragma GCC diagnostic pop
