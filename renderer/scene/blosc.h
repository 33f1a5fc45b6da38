// SPDX-License-Identifier: MIT
// Decompresses buffers of Blosc 1 with LZ4, in which OpenVDB stores values.
//
// A buffer has a header of 16 bytes, the places of its blocks, and the blocks. A block consists of one
// stream, or of one per byte of a value; each is LZ4 (https://github.com/lz4/lz4, "LZ4 Block Format
// Description") or stored. The bytes of a block are in the order of all first bytes of values, then all
// second ones (shuffle). The layout is that of C-Blosc (https://github.com/Blosc/c-blosc).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace alpenglow::renderer {

/// Returns the bytes of a buffer. Throws InputError, without a file's name, for damaged buffers, other
/// codecs, bit-shuffled bytes, and buffers of another size.
/// @param bytes  the number of bytes that the buffer must have.
[[nodiscard]] std::string UnpackedBlosc(std::string_view packed, std::size_t bytes);

}  // namespace alpenglow::renderer
