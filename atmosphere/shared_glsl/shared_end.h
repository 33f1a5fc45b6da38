// SPDX-License-Identifier: MIT
// Ends the region that shared_begin.h opened.
#undef SHARED
#undef SHARED_BITS
#undef SHARED_CONSTANT
#undef Number
#undef Length
#undef Bits
#pragma GCC diagnostic pop
