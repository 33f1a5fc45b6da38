// SPDX-License-Identifier: MIT
// FNV-1a, 64 bits (Fowler, Noll, Vo; draft-eastlake-fnv), over little-endian bytes; -0 reads as 0.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace alpenglow::atmosphere {

class Fnv1a {
 public:
  void Add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte, word >>= 8) {
      hash_ = (hash_ ^ (word & 0xffU)) * 0x100000001b3U;
    }
  }
  void Add(double value) { Add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }
  void Add(const std::vector<double>& values) {
    Add(std::uint64_t{values.size()});
    for (const double value : values) Add(value);
  }
  void Add(const std::string& text) {
    Add(std::uint64_t{text.size()});
    for (const char letter : text) Add(std::uint64_t{static_cast<unsigned char>(letter)});
  }

  [[nodiscard]] std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

}  // namespace alpenglow::atmosphere
