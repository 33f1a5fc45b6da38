// SPDX-License-Identifier: MIT
#include "renderer/scene/vdb_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/layer.h"
#include "renderer/scene/blosc.h"

namespace alpenglow::renderer {
namespace {

static_assert(std::endian::native == std::endian::little, "OpenVDB files are little endian");

constexpr std::uint32_t kLeastVdbVersion = 222, kMostVdbVersion = 224;
constexpr std::uint32_t kZip = 1, kActiveMask = 2, kBlosc = 4;
constexpr std::string_view kVdbFloats = "Tree_float_5_4_3", kHalfSuffix = "_HalfFloat";

/// The bytes of a file and a place in them.
class VdbBytes {
 public:
  explicit VdbBytes(std::string bytes) : bytes_(std::move(bytes)) {}

  [[nodiscard]] std::string_view Take(std::size_t count) {
    if (count > bytes_.size() - at_) {
      throw InputError(fmt::format("the file ends at byte {}, before {} bytes that it needs at {}",
                                   bytes_.size(), count, at_));
    }
    const std::string_view taken = std::string_view(bytes_).substr(at_, count);
    at_ += count;
    return taken;
  }
  template <typename Number>
  [[nodiscard]] Number Next() {
    Number number;
    std::memcpy(&number, Take(sizeof(Number)).data(), sizeof(Number));
    return number;
  }
  [[nodiscard]] std::string Text() { return std::string(Take(Next<std::uint32_t>())); }
  void Skip(std::size_t count) { (void)Take(count); }
  void MoveTo(std::int64_t place) {
    if (place < 0 || static_cast<std::uint64_t>(place) > bytes_.size()) {
      throw InputError(fmt::format("a grid at byte {} of {}", place, bytes_.size()));
    }
    at_ = static_cast<std::size_t>(place);
  }
  [[nodiscard]] bool StartsWith(std::string_view magic) const { return bytes_.starts_with(magic); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

/// One bit per child or value of a node.
class NodeMask {
 public:
  NodeMask() = default;
  NodeMask(VdbBytes& bytes, std::size_t count) : bits_(bytes.Take(count / 8)) {}
  [[nodiscard]] bool IsOn(std::size_t i) const {
    return !bits_.empty() && (static_cast<unsigned char>(bits_[i / 8]) >> (i % 8) & 1U) != 0;
  }
  [[nodiscard]] std::size_t Count() const {
    std::size_t count = 0;
    for (const char byte : bits_) {
      count += static_cast<std::size_t>(std::popcount(static_cast<unsigned char>(byte)));
    }
    return count;
  }

 private:
  std::string_view bits_;
};

float FloatOfHalf(std::uint16_t half) {
  const int exponent = half >> 10U & 31U, fraction = half & 1023U;
  const float sign = (half >> 15U) != 0 ? -1.0F : 1.0F;
  if (exponent == 31) {
    return fraction != 0 ? std::numeric_limits<float>::quiet_NaN()
                         : sign * std::numeric_limits<float>::infinity();
  }
  if (exponent == 0) return sign * std::ldexp(static_cast<float>(fraction), -24);
  return sign * std::ldexp(static_cast<float>(fraction + 1024), exponent - 25);
}

/// The storage of the values of a grid.
struct ValueCoding {
  std::uint32_t compression = 0;
  bool is_half = false;
  float background = 0.0F;
};

/// Returns `bytes` bytes that may be compressed.
std::string StoredBytes(VdbBytes& file, std::size_t bytes, std::uint32_t compression) {
  if ((compression & (kZip | kBlosc)) == 0) return std::string(file.Take(bytes));
  const auto packed_bytes = file.Next<std::int64_t>();
  if (packed_bytes <= 0) {
    if (packed_bytes != -static_cast<std::int64_t>(bytes)) {
      throw InputError(fmt::format("values of another size than {} bytes", bytes));
    }
    return std::string(file.Take(bytes));
  }
  const std::string_view packed = file.Take(static_cast<std::size_t>(packed_bytes));
  if ((compression & kBlosc) != 0) return UnpackedBlosc(packed, bytes);
  std::string values(bytes, '\0');
  auto size = static_cast<uLongf>(bytes);
  const int status =
      uncompress(reinterpret_cast<Bytef*>(values.data()), &size,
                 reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  if (status != Z_OK || size != bytes) throw InputError("the zlib data are damaged");
  return values;
}

std::vector<float> StoredFloats(VdbBytes& file, std::size_t count, const ValueCoding& coding) {
  std::vector<float> values(count);
  // OpenVDB writes the size of no floats, but not that of no halves.
  if (count == 0 && coding.is_half) return values;
  const std::size_t value_bytes = coding.is_half ? 2 : 4;
  const std::string bytes = StoredBytes(file, value_bytes * count, coding.compression);
  for (std::size_t i = 0; i < count; ++i) {
    if (coding.is_half) {
      std::uint16_t half;
      std::memcpy(&half, bytes.data() + 2 * i, 2);
      values[i] = FloatOfHalf(half);
    } else {
      std::memcpy(&values[i], bytes.data() + 4 * i, 4);
    }
  }
  return values;
}

/// The inactive values of a node.
enum class InactiveValues : std::uint8_t {
  kBackground,
  kMinusBackground,
  kOne,
  kMinusOrBackground,
  kOneOrBackground,
  kTwo,
  kAll
};

/// Returns all values of a node or leaf.
std::vector<float> NodeValues(VdbBytes& file, std::size_t count, const NodeMask& is_active,
                              const ValueCoding& coding) {
  const auto code = file.Next<std::uint8_t>();
  if (code > static_cast<std::uint8_t>(InactiveValues::kAll)) {
    throw InputError(fmt::format("a node with the unknown code {}", code));
  }
  const auto inactive = static_cast<InactiveValues>(code);
  using enum InactiveValues;
  float first = inactive == kBackground ? coding.background : -coding.background;
  float second = coding.background;
  if (inactive == kOne || inactive == kOneOrBackground || inactive == kTwo) {
    first = file.Next<float>();
  }
  if (inactive == kTwo) second = file.Next<float>();
  NodeMask is_second;
  if (inactive == kMinusOrBackground || inactive == kOneOrBackground || inactive == kTwo) {
    is_second = NodeMask(file, count);
  }
  if ((coding.compression & kActiveMask) == 0 || inactive == kAll) {
    return StoredFloats(file, count, coding);
  }
  const std::vector<float> active = StoredFloats(file, is_active.Count(), coding);
  std::vector<float> values(count);
  auto next = active.begin();
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = is_active.IsOn(i) ? *next++ : is_second.IsOn(i) ? second : first;
  }
  return values;
}

using VdbIndex = std::array<std::int64_t, 3>;

/// A cube of equal values, or a leaf.
struct VdbCube {
  VdbIndex origin;
  std::int64_t side;
  std::vector<float> values;  // one, or those of a leaf, z fastest
  bool is_active;
};

/// Adds the indices of place number i in a node with 2^log2 places along each axis.
VdbIndex ChildOrigin(const VdbIndex& origin, std::size_t i, unsigned log2, std::int64_t side) {
  const std::size_t last = (std::size_t{1} << log2) - 1;
  return {origin[0] + side * static_cast<std::int64_t>(i >> (2 * log2)),
          origin[1] + side * static_cast<std::int64_t>(i >> log2 & last),
          origin[2] + side * static_cast<std::int64_t>(i & last)};
}

/// Reads the tree of a grid.
class VdbTree {
 public:
  VdbTree(VdbBytes& file, ValueCoding coding) : file_(file), coding_(coding) {
    if (file_.Next<std::int32_t>() != 1) throw InputError("a tree with several buffers");
    coding_.background = file_.Next<float>();
    const auto tiles = file_.Next<std::uint32_t>(), children = file_.Next<std::uint32_t>();
    for (std::uint32_t i = 0; i < tiles; ++i) {
      const VdbIndex origin = Index();
      const auto value = file_.Next<float>();
      cubes_.push_back({origin, std::int64_t{1} << 12U, {value}, file_.Next<std::uint8_t>() != 0});
    }
    for (std::uint32_t i = 0; i < children; ++i) ReadNode(Index(), 5);
    for (VdbCube& leaf : leaves_) ReadLeaf(leaf);
  }

  /// Returns the grid in the box of its active values.
  [[nodiscard]] VdbGrid InBox(double most_values) const {
    constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
    VdbIndex low{kMost, kMost, kMost}, high{-kMost, -kMost, -kMost};
    for (const auto* cubes : {&cubes_, &leaves_}) {
      for (const VdbCube& cube : *cubes) {
        if (!cube.is_active) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          low[axis] = std::min(low[axis], cube.origin[axis]);
          high[axis] = std::max(high[axis], cube.origin[axis] + cube.side);
        }
      }
    }
    if (low[0] > high[0]) throw InputError("the grid has no active values");
    VdbGrid grid;
    double values = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values *= static_cast<double>(high[axis] - low[axis]);
      grid.size[axis] = static_cast<int>(std::min<std::int64_t>(high[axis] - low[axis], 1 << 30));
      grid.origin[static_cast<int>(axis)] = static_cast<double>(low[axis]);
    }
    if (values > most_values) {
      throw InputError(fmt::format("a box of {} x {} x {} values; there may be {:.0f} at most",
                                   grid.size[0], grid.size[1], grid.size[2], most_values));
    }
    grid.background = coding_.background;
    grid.values.assign(static_cast<std::size_t>(values), coding_.background);
    for (const auto* cubes : {&cubes_, &leaves_}) {
      for (const VdbCube& cube : *cubes) Copy(cube, low, grid);
    }
    return grid;
  }

 private:
  [[nodiscard]] VdbIndex Index() {
    const auto x = file_.Next<std::int32_t>(), y = file_.Next<std::int32_t>();
    return {x, y, file_.Next<std::int32_t>()};
  }

  /// Reads a node of 2^log2 places along each axis, and the nodes in it.
  void ReadNode(const VdbIndex& origin, unsigned log2) {
    const std::size_t places = std::size_t{1} << (3 * log2);
    const std::int64_t side = log2 == 5 ? 128 : 8;
    const NodeMask has_child(file_, places), is_active(file_, places);
    const std::vector<float> values = NodeValues(file_, places, is_active, coding_);
    for (std::size_t i = 0; i < places; ++i) {
      if (has_child.IsOn(i)) continue;
      if (!is_active.IsOn(i) && values[i] == coding_.background) continue;
      cubes_.push_back({ChildOrigin(origin, i, log2, side), side, {values[i]}, is_active.IsOn(i)});
    }
    for (std::size_t i = 0; i < places; ++i) {
      if (!has_child.IsOn(i)) continue;
      const VdbIndex child = ChildOrigin(origin, i, log2, side);
      if (log2 == 5) {
        ReadNode(child, 4);
      } else {
        file_.Skip(kLeafMask);  // stands again before the values
        leaves_.push_back({child, 8, {}, true});
      }
    }
  }

  void ReadLeaf(VdbCube& leaf) {
    const NodeMask is_active(file_, 8 * kLeafMask);
    leaf.is_active = is_active.Count() > 0;
    leaf.values = NodeValues(file_, 8 * kLeafMask, is_active, coding_);
  }

  /// Copies the part of a cube that lies in the box of a grid.
  static void Copy(const VdbCube& cube, const VdbIndex& low, VdbGrid& grid) {
    VdbIndex begin{}, end{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      begin[axis] = std::max<std::int64_t>(cube.origin[axis] - low[axis], 0);
      end[axis] =
          std::min<std::int64_t>(cube.origin[axis] + cube.side - low[axis], grid.size[axis]);
    }
    for (std::int64_t z = begin[2]; z < end[2]; ++z) {
      for (std::int64_t y = begin[1]; y < end[1]; ++y) {
        for (std::int64_t x = begin[0]; x < end[0]; ++x) {
          const auto in_cube = [&](std::int64_t at, std::size_t axis) {
            return static_cast<std::size_t>(at + low[axis] - cube.origin[axis]);
          };
          const std::size_t number =
              cube.values.size() == 1 ? 0 : (in_cube(x, 0) * 8 + in_cube(y, 1)) * 8 + in_cube(z, 2);
          grid.values[static_cast<std::size_t>((z * grid.size[1] + y) * grid.size[0] + x)] =
              cube.values[number];
        }
      }
    }
  }

  static constexpr std::size_t kLeafMask = 64;  // bytes

  VdbBytes& file_;
  ValueCoding coding_;
  std::vector<VdbCube> cubes_, leaves_;
};

/// Reads metadata and forgets them.
void SkipMetadata(VdbBytes& file) {
  const auto count = file.Next<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    file.Skip(file.Next<std::uint32_t>());  // name
    file.Skip(file.Next<std::uint32_t>());  // type
    file.Skip(file.Next<std::uint32_t>());  // value
  }
}

/// From indices to space.
struct VdbTransform {
  glm::dvec3 scale{1.0}, offset{0.0};
};

glm::dvec3 NextVector(VdbBytes& file) {
  const auto x = file.Next<double>(), y = file.Next<double>();
  return {x, y, file.Next<double>()};
}

VdbTransform AffineTransform(VdbBytes& file) {
  std::array<std::array<double, 4>, 4> rows{};
  for (auto& row : rows) {
    for (double& value : row) value = file.Next<double>();
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (i != j && std::abs(rows[i][j]) > 1e-9 * std::abs(rows[i][i])) {
        throw InputError("the transform turns or shears the grid; it may scale and move it");
      }
    }
  }
  return {{rows[0][0], rows[1][1], rows[2][2]}, {rows[3][0], rows[3][1], rows[3][2]}};
}

VdbTransform TransformOf(VdbBytes& file) {
  constexpr std::size_t kDerived = 4 * 3 * sizeof(double);  // four vectors follow the scale
  const std::string type = file.Text();
  VdbTransform transform;
  if (type == "UniformScaleMap" || type == "ScaleMap") {
    transform.scale = NextVector(file);
    file.Skip(kDerived);
  } else if (type == "UniformScaleTranslateMap" || type == "ScaleTranslateMap") {
    transform.offset = NextVector(file);
    transform.scale = NextVector(file);
    file.Skip(kDerived);
  } else if (type == "TranslationMap") {
    transform.offset = NextVector(file);
  } else if (type == "AffineMap") {
    transform = AffineTransform(file);
  } else {
    throw InputError(fmt::format("the transform \"{}\" is not read", Printable(type)));
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(transform.scale[axis]) || transform.scale[axis] == 0.0 ||
        !std::isfinite(transform.offset[axis])) {
      throw InputError(fmt::format("the transform has the scale {} and the offset {} along axis {}",
                                   transform.scale[axis], transform.offset[axis], axis));
    }
  }
  return transform;
}

/// The place of a grid in the file.
struct VdbDescriptor {
  std::string name, type;
  std::int64_t place = 0, end = 0;
  bool is_half = false;

  [[nodiscard]] bool HasFloats() const { return type == kVdbFloats; }
};

VdbDescriptor NextDescriptor(VdbBytes& file) {
  VdbDescriptor grid;
  grid.name = file.Text();
  grid.name = grid.name.substr(0, grid.name.find('\x1e'));  // a number follows equal names
  grid.type = file.Text();
  if (grid.type.ends_with(kHalfSuffix)) {
    grid.is_half = true;
    grid.type.resize(grid.type.size() - kHalfSuffix.size());
  }
  if (!file.Text().empty()) grid.type = "an instance of another grid";
  grid.place = file.Next<std::int64_t>();
  file.Skip(sizeof(std::int64_t));
  grid.end = file.Next<std::int64_t>();
  return grid;
}

std::vector<VdbDescriptor> DescriptorsOf(VdbBytes& file) {
  constexpr std::string_view kMagic(" BDV\0\0\0\0", 8);
  if (!file.StartsWith(kMagic)) throw InputError("this is not an OpenVDB file");
  file.Skip(kMagic.size());
  const auto version = file.Next<std::uint32_t>();
  if (version < kLeastVdbVersion || version > kMostVdbVersion) {
    throw InputError(fmt::format("OpenVDB files of version {} are not read; it must be in [{}, {}]",
                                 version, kLeastVdbVersion, kMostVdbVersion));
  }
  file.Skip(8);  // version of the library
  if (file.Next<std::uint8_t>() == 0) throw InputError("a stream without the places of its grids");
  constexpr std::size_t kUniqueName = 36;
  file.Skip(kUniqueName);
  SkipMetadata(file);
  const auto count = file.Next<std::int32_t>();
  std::vector<VdbDescriptor> grids;
  for (std::int32_t i = 0; i < count; ++i) {
    grids.push_back(NextDescriptor(file));
    file.MoveTo(grids.back().end);
  }
  return grids;
}

const VdbDescriptor& ChosenGrid(const std::vector<VdbDescriptor>& grids, std::string_view name) {
  const VdbDescriptor* chosen = nullptr;
  std::string all;
  for (const VdbDescriptor& grid : grids) {
    all += fmt::format("{}\"{}\" ({})", all.empty() ? "" : ", ", Printable(grid.name),
                       Printable(grid.type));
    const bool is_named = grid.name == (name.empty() ? "density" : name);
    if (is_named && !name.empty() && !grid.HasFloats()) {
      throw InputError(fmt::format("grid \"{}\" is {}; it must be {}", Printable(grid.name),
                                   Printable(grid.type), kVdbFloats));
    }
    if (grid.HasFloats() && (is_named || (name.empty() && !chosen))) chosen = &grid;
  }
  if (!chosen) {
    throw InputError(fmt::format("there is no grid{} of floats; the file has {}",
                                 name.empty() ? "" : fmt::format(" \"{}\"", Printable(name)),
                                 all.empty() ? "none" : all));
  }
  return *chosen;
}

VdbGrid GridOfBytes(VdbBytes file, std::string_view grid_name, double most_values) {
  const std::vector<VdbDescriptor> grids = DescriptorsOf(file);
  const VdbDescriptor& chosen = ChosenGrid(grids, grid_name);
  file.MoveTo(chosen.place);
  ValueCoding coding{file.Next<std::uint32_t>(), chosen.is_half};
  if ((coding.compression & ~(kZip | kActiveMask | kBlosc)) != 0) {
    throw InputError(fmt::format("the compression {} is not read", coding.compression));
  }
  SkipMetadata(file);
  const VdbTransform transform = TransformOf(file);
  VdbGrid grid = VdbTree(file, coding).InBox(most_values);
  grid.name = chosen.name;
  grid.origin = transform.offset + transform.scale * grid.origin;
  grid.spacing = transform.scale;
  return grid;
}

}  // namespace

VdbGrid ReadVdb(const std::filesystem::path& file, std::string_view grid_name, double most_values) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) RefuseFile(file, "cannot be read");
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) RefuseFile(file, "cannot be read to its end");
  try {
    return GridOfBytes(VdbBytes(std::move(bytes)), grid_name, most_values);
  } catch (const InputError& error) {
    RefuseFile(file, error.what());
  }
}

}  // namespace alpenglow::renderer
