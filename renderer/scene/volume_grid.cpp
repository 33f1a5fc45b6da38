// SPDX-License-Identifier: MIT
// Densities on a grid and their files: NRRD and raw.
#include "renderer/scene/volume_grid.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/base/error.h"
#include "renderer/layer.h"
#include "renderer/scene/nrrd_header.h"

namespace alpenglow::renderer {
namespace {

constexpr int kBlock = 4;  // samples per side

/// Finds the next crossing of a line with the planes `first + step k` of one axis.
class PlaneWalk {
 public:
  // @param at  coordinate at t = begin, in units of planes.
  PlaneWalk(double at, double slope, double begin) : slope_(slope) {
    if (slope_ == 0.0) return;
    const double next = slope_ > 0.0 ? std::floor(at) + 1.0 : std::ceil(at) - 1.0;
    next_ = begin + (next - at) / slope_;
    step_ = 1.0 / std::abs(slope_);
  }
  [[nodiscard]] double next() const { return next_; }
  void Pass() { next_ += step_; }

 private:
  double slope_;
  double next_ = std::numeric_limits<double>::infinity();
  double step_ = 0.0;
};

/// Calls visit(begin, end) for the pieces of a line between planes at integer coordinates.
template <typename Visit>
void WalkPlanes(const glm::dvec3& origin, const glm::dvec3& direction, double begin, double end,
                const Visit& visit) {
  const glm::dvec3 at = origin + begin * direction;
  std::array<PlaneWalk, 3> walks{PlaneWalk(at.x, direction.x, begin),
                                 PlaneWalk(at.y, direction.y, begin),
                                 PlaneWalk(at.z, direction.z, begin)};
  double from = begin;
  while (from < end) {
    PlaneWalk& nearest = *std::min_element(
        walks.begin(), walks.end(),
        [](const PlaneWalk& a, const PlaneWalk& b) { return a.next() < b.next(); });
    const double to = std::min(nearest.next(), end);
    if (to > from) visit(from, to);
    from = std::max(from, to);
    nearest.Pass();
  }
}

std::size_t CountOf(const std::array<int, 3>& size) {
  std::size_t count = 1;
  for (const int side : size) count *= static_cast<std::size_t>(side);
  return count;
}

}  // namespace

void CheckGridSize(const std::array<int, 3>& size) {
  for (const int side : size) {
    if (!(side >= 2 && side <= kMostGridSamples)) {
      throw InputError(fmt::format("a grid of {} x {} x {} samples; each side must have 2 to {}",
                                   size[0], size[1], size[2], kMostGridSamples));
    }
  }
}

VolumeGrid::VolumeGrid(const std::array<int, 3>& size, std::vector<float> values)
    : size_(size), values_(std::move(values)) {
  CheckGridSize(size);
  if (values_.size() != CountOf(size)) {
    throw InputError(fmt::format("{} values for a grid of {} x {} x {} samples", values_.size(),
                                 size[0], size[1], size[2]));
  }
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (!(values_[i] >= 0.0F && std::isfinite(values_[i]))) {
      throw InputError(
          fmt::format("value {} of the grid is {}; densities must be finite and not "
                      "negative",
                      i, values_[i]));
    }
  }
  FindLargest();
}

void VolumeGrid::FindLargest() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    blocks_[axis] = (size_[axis] - 2) / kBlock + 1;
  }
  for (int bz = 0; bz < blocks_[2]; ++bz) {
    for (int by = 0; by < blocks_[1]; ++by) {
      for (int bx = 0; bx < blocks_[0]; ++bx) {
        float most = 0.0F;
        for (int z = kBlock * bz; z <= std::min(kBlock * (bz + 1), size_[2] - 1); ++z) {
          for (int y = kBlock * by; y <= std::min(kBlock * (by + 1), size_[1] - 1); ++y) {
            for (int x = kBlock * bx; x <= std::min(kBlock * (bx + 1), size_[0] - 1); ++x) {
              most = std::max(most, values_[Index(x, y, z)]);
            }
          }
        }
        largest_in_block_.push_back(most);
        largest_ = std::max(largest_, static_cast<double>(most));
      }
    }
  }
}

double VolumeGrid::At(const glm::dvec3& point) const {
  std::array<int, 3> low{};
  std::array<double, 3> share{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double u = std::clamp(point[axis] * size_[a] - 0.5, 0.0, size_[a] - 1.0);
    low[a] = std::min(static_cast<int>(u), size_[a] - 2);
    share[a] = u - low[a];
  }
  const auto along_x = [&](int y, int z) {
    const float* row = values_.data() + Index(low[0], low[1] + y, low[2] + z);
    return (1.0 - share[0]) * static_cast<double>(row[0]) + share[0] * static_cast<double>(row[1]);
  };
  const auto along_xy = [&](int z) {
    return (1.0 - share[1]) * along_x(0, z) + share[1] * along_x(1, z);
  };
  return (1.0 - share[2]) * along_xy(0) + share[2] * along_xy(1);
}

std::vector<VolumeGrid::Piece> VolumeGrid::PiecesAlong(const glm::dvec3& origin,
                                                       const glm::dvec3& direction, double begin,
                                                       double end) const {
  const glm::dvec3 scale = glm::dvec3(size_[0], size_[1], size_[2]) / double{kBlock};
  const glm::dvec3 from = origin * scale - 0.5 / kBlock;
  const glm::dvec3 slope = direction * scale;
  std::vector<Piece> pieces;
  WalkPlanes(from, slope, begin, end, [&](double a, double b) {
    const glm::dvec3 middle = from + 0.5 * (a + b) * slope;
    std::size_t index = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int blocks = blocks_[static_cast<std::size_t>(axis)];
      const int block = std::clamp(static_cast<int>(std::floor(middle[axis])), 0, blocks - 1);
      index = index * static_cast<std::size_t>(blocks) + static_cast<std::size_t>(block);
    }
    const auto largest = static_cast<double>(largest_in_block_[index]);
    if (largest > 0.0) pieces.push_back({a, b, largest});
  });
  return pieces;
}

double VolumeGrid::Column(const glm::dvec3& origin, const glm::dvec3& direction, double begin,
                          double end) const {
  constexpr double kGauss = 0.21132486540518712;  // (1 - 1 / sqrt 3) / 2
  const glm::dvec3 scale(size_[0], size_[1], size_[2]);
  double sum = 0.0;
  for (const Piece& piece : PiecesAlong(origin, direction, begin, end)) {
    WalkPlanes(
        origin * scale - 0.5, direction * scale, piece.begin, piece.end, [&](double a, double b) {
          const double near = a + kGauss * (b - a);
          const double far = b - kGauss * (b - a);
          sum += 0.5 * (b - a) * (At(origin + near * direction) + At(origin + far * direction));
        });
  }
  return sum;
}

namespace {

namespace fs = std::filesystem;

std::string BytesAfter(const fs::path& file, std::size_t begin) {
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(begin));
  std::ostringstream text;
  if (stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (stream.bad() || !stream.is_open() || !text) {
    throw InputError("cannot be read");
  }
  return std::move(text).str();
}

std::size_t StoredCountOf(const std::array<int, 3>& size) {
  std::size_t count = 1;
  for (const int side : size) count *= static_cast<std::size_t>(side);
  return count;
}

float FloatAt(const char* bytes, bool is_big_endian) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    bits = bits << 8U | static_cast<unsigned char>(bytes[is_big_endian ? i : 3 - i]);
  }
  return std::bit_cast<float>(bits);
}

VolumeGrid FromBytes(const NrrdHeader& header, std::string_view data) {
  const std::array<int, 3>& size = header.size;
  const bool is_float = header.type == NrrdHeader::Type::kFloat;
  const std::size_t bytes = StoredCountOf(size) * (is_float ? 4 : 1);
  if (data.size() != bytes) {
    throw InputError(fmt::format("{} bytes of data; {} x {} x {} {} are {}", data.size(), size[0],
                                 size[1], size[2], is_float ? "floats" : "bytes", bytes));
  }
  std::vector<float> values(StoredCountOf(size));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = is_float ? FloatAt(data.data() + 4 * i, header.is_big_endian)
                         : static_cast<float>(static_cast<unsigned char>(data[i])) / 255.0F;
  }
  return {size, std::move(values)};
}

/// A zlib stream with automatic cleanup.
class Inflater {
 public:
  Inflater() {
    constexpr int kGzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzip) != Z_OK) throw InternalError("zlib does not start");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Returns the decompressed data, at most `most` bytes.
  std::string Unpacked(std::string packed, std::size_t most) {
    std::string data(most, '\0');
    std::size_t read = 0, written = 0;
    while (written < most && read < packed.size()) {
      stream_.next_in = reinterpret_cast<Bytef*>(packed.data() + read);
      stream_.next_out = reinterpret_cast<Bytef*>(data.data() + written);
      const uInt in = stream_.avail_in = Piece(packed.size() - read);
      const uInt out = stream_.avail_out = Piece(most - written);
      const int status = inflate(&stream_, Z_NO_FLUSH);
      read += in - stream_.avail_in;
      written += out - stream_.avail_out;
      if (status == Z_STREAM_END) {  // another member can follow
        inflateReset(&stream_);
      } else if (status != Z_OK) {
        throw InputError(fmt::format("the gzip data are damaged at byte {}", read));
      }
    }
    data.resize(written);
    return data;
  }

 private:
  static uInt Piece(std::size_t bytes) {
    return static_cast<uInt>(std::min<std::size_t>(bytes, 1U << 30U));
  }
  z_stream stream_{};
};

std::string WithoutLines(std::string bytes, int lines) {
  std::size_t begin = 0;
  for (int i = 0; i < lines; ++i) {
    const std::size_t end = bytes.find('\n', begin);
    if (end == std::string::npos) {
      throw InputError(fmt::format("has {} lines; line skip is {}", i, lines));
    }
    begin = end + 1;
  }
  return bytes.substr(begin);
}

std::string DataOf(const NrrdHeader& header) {
  std::string bytes =
      WithoutLines(BytesAfter(header.data_file, header.data_begin), header.line_skip);
  const std::size_t wanted =
      StoredCountOf(header.size) * (header.type == NrrdHeader::Type::kFloat ? 4 : 1);
  if (header.byte_skip < 0) {
    return bytes.substr(bytes.size() - std::min(bytes.size(), wanted));
  }
  const auto skipped = static_cast<std::size_t>(header.byte_skip);
  if (header.encoding == NrrdHeader::Encoding::kGzip) {
    // One more byte reveals excess data.
    bytes = Inflater().Unpacked(std::move(bytes), wanted + skipped + 1);
  }
  return bytes.substr(std::min(bytes.size(), skipped));
}

// Returns the values in the axis order of space: right fastest, up slowest.
VolumeGrid InSpace(const NrrdHeader& header, const VolumeGrid& grid) {
  if (header.space_axis == std::array<std::size_t, 3>{0, 1, 2} &&
      header.is_reversed == std::array<bool, 3>{}) {
    return grid;
  }
  std::array<int, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis) size[header.space_axis[axis]] = header.size[axis];
  const std::array<std::size_t, 3> stride{
      1, static_cast<std::size_t>(size[0]),
      static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1])};
  const auto step = [&](std::size_t axis, int i) {
    const int along = header.is_reversed[axis] ? header.size[axis] - 1 - i : i;
    return static_cast<std::size_t>(along) * stride[header.space_axis[axis]];
  };
  std::vector<float> values(grid.values().size());
  auto value = grid.values().begin();
  for (int k = 0; k < header.size[2]; ++k) {
    for (int j = 0; j < header.size[1]; ++j) {
      for (int i = 0; i < header.size[0]; ++i) {
        values[step(0, i) + step(1, j) + step(2, k)] = *value++;
      }
    }
  }
  return {size, std::move(values)};
}

// Runs a reading step and adds the file name to its errors.
template <typename Read>
VolumeGrid NamingItsFile(const fs::path& file, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace

VolumeGrid ReadNrrd(const fs::path& file) {
  const NrrdHeader header = ReadNrrdHeader(file);
  return NamingItsFile(header.data_file, [&] {
    CheckGridSize(header.size);
    return InSpace(header, FromBytes(header, DataOf(header)));
  });
}

VolumeGrid ReadRawGrid(const fs::path& file, const std::array<int, 3>& size) {
  NrrdHeader header;
  header.size = size;
  return NamingItsFile(file, [&] {
    CheckGridSize(size);
    return FromBytes(header, BytesAfter(file, 0));
  });
}

}  // namespace alpenglow::renderer
