// SPDX-License-Identifier: MIT
#include "renderer/scene/volume_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "atmosphere/base/parsing.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestHeader = 1U << 20U;  // bytes

// Reads the first bytes of a file, more than a header needs.
std::string FirstBytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text(kLongestHeader, '\0');
  if (!stream.read(text.data(), static_cast<std::streamsize>(text.size())) && !stream.eof())
    throw InputError(fmt::format("{}: cannot be read", file.string()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

// Parses "(1,0,0) (0,1,0) (0,0,1)" into rows; empty for any other text.
std::vector<std::array<double, 3>> VectorsOf(std::string_view value) {
  std::vector<std::array<double, 3>> vectors;
  for (value = Trimmed(value); !value.empty(); value = Trimmed(value)) {
    const std::size_t close = value.find(')');
    if (value.front() != '(' || close == std::string_view::npos) return {};
    const CsvRecord parts = SplitCsv(value.substr(1, close - 1));
    if (parts.fields.size() != 3) return {};
    std::array<double, 3>& vector = vectors.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<double> number = ParseNumber(parts.fields[axis]);
      if (!number) return {};
      vector[axis] = *number;
    }
    value.remove_prefix(close + 1);
  }
  return vectors;
}

/// A word of the format and its value.
template <typename Value>
struct Word {
  const char* name;
  Value value;
};

constexpr Word<NrrdHeader::Type> kTypes[] = {{"float", NrrdHeader::Type::kFloat},
                                             {"uint8", NrrdHeader::Type::kByte},
                                             {"uint8_t", NrrdHeader::Type::kByte},
                                             {"uchar", NrrdHeader::Type::kByte},
                                             {"unsigned char", NrrdHeader::Type::kByte}};
constexpr Word<NrrdHeader::Encoding> kEncodings[] = {{"raw", NrrdHeader::Encoding::kRaw},
                                                     {"gzip", NrrdHeader::Encoding::kGzip},
                                                     {"gz", NrrdHeader::Encoding::kGzip}};
constexpr Word<bool> kEndians[] = {{"little", false}, {"big", true}};
// The spaces. Each flag tells whether an axis points against right, ahead (anterior) or up
// (superior).
constexpr Word<std::array<bool, 3>> kSpaces[] = {
    {"3d-right-handed", {false, false, false}},         {"ras", {false, false, false}},
    {"right-anterior-superior", {false, false, false}}, {"las", {true, false, false}},
    {"left-anterior-superior", {true, false, false}},   {"lps", {true, true, false}},
    {"left-posterior-superior", {true, true, false}}};

constexpr const char* kPassedOver[] = {
    "content",     "number",     "sample units", "sampleunits",      "units",
    "space units", "labels",     "thicknesses",  "space origin",     "min",
    "max",         "block size", "blocksize",    "measurement frame"};

class HeaderReader {
 public:
  HeaderReader(const fs::path& file, std::string_view text) : file_(file), text_(text) {
    header_.data_file = file;
  }

  [[nodiscard]] NrrdHeader Header() {
    if (Line().value_or("").substr(0, 7) != "NRRD000") Fail("not an NRRD file");
    std::optional<std::string_view> line = Line();
    for (; line && !line->empty(); line = Line()) Take(*line);
    if (!line && !Has("data file")) Fail("the header has no end");
    if (!Has("sizes") || !Has("type") || !Has("encoding"))
      Fail("the header must have sizes, type and encoding");
    if (!Has("data file")) header_.data_begin = at_;
    if (header_.byte_skip == -1 && header_.encoding != NrrdHeader::Encoding::kRaw) {
      Fail("byte skip is -1; this is for encoding raw");
    }
    Orient();
    return header_;
  }

 private:
  // Returns the next line; empty at the end of the text.
  std::optional<std::string_view> Line() {
    if (at_ >= text_.size()) return std::nullopt;
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos && text_.size() == kLongestHeader)
      Fail("the header has no end");
    std::string_view line = text_.substr(at_, std::min(end, text_.size()) - at_);
    at_ = std::min(end, text_.size() - 1) + 1;
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  [[nodiscard]] bool Has(const char* field) const { return seen_.count(field) > 0; }

  void Take(std::string_view line) {
    if (line.front() == '#') return;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) Fail("a line of the header without \":\"");
    if (line.substr(colon, 2) == ":=") return;  // user-defined key and value
    std::string field = LowerCase(Trimmed(line.substr(0, colon)));
    if (field == "datafile") field = "data file";
    if (field == "lineskip") field = "line skip";
    if (field == "byteskip") field = "byte skip";
    if (field == "centerings") field = "centers";
    if (field == "axismins") field = "axis mins";
    if (field == "axismaxs") field = "axis maxs";
    if (!seen_.insert(field).second) Fail(fmt::format("\"{}\" stands twice", field));
    const std::string value(Trimmed(line.substr(colon + 1)));
    if (!TakeLayout(field, value) && !TakeData(field, value) && !TakeSpace(field, value) &&
        std::find(std::begin(kPassedOver), std::end(kPassedOver), field) == std::end(kPassedOver)) {
      Fail(fmt::format("\"{}\" is not read", field));
    }
  }

  bool TakeLayout(const std::string& field, const std::string& value) {
    if (field == "type") {
      header_.type = Among(kTypes, field, value, "\"float\" or \"uint8\"");
    } else if (field == "dimension") {
      if (value != "3") Fail(fmt::format("dimension is {}; it must be 3", value));
    } else if (field == "sizes") {
      TakeSizes(value);
    } else if (field == "centers") {
      RequireWords(field, value, {"cell", "???", "none"}, "\"cell\"");
    } else if (field == "kinds") {
      RequireWords(field, value, {"domain", "space", "???", "none"}, "\"domain\" or \"space\"");
    } else {
      return false;
    }
    return true;
  }

  bool TakeData(const std::string& field, const std::string& value) {
    if (field == "encoding") {
      header_.encoding = Among(kEncodings, field, value, "\"raw\" or \"gzip\"");
    } else if (field == "endian") {
      header_.is_big_endian = Among(kEndians, field, value, "\"little\" or \"big\"");
    } else if (field == "line skip") {
      header_.line_skip = Skip(field, value, 0);
    } else if (field == "byte skip") {
      header_.byte_skip = Skip(field, value, -1);
    } else if (field == "data file") {
      if (value.empty() || WordsOf(value)[0] == "LIST" || value.find('%') != std::string::npos) {
        Fail(fmt::format("data file is \"{}\"; it must be the name of one file", value));
      }
      header_.data_file = file_.parent_path() / value;
    } else {
      return false;
    }
    return true;
  }

  bool TakeSpace(const std::string& field, const std::string& value) {
    if (field == "space") {
      space_ = Among(kSpaces, field, value,
                     "\"right-anterior-superior\", \"left-anterior-superior\", "
                     "\"left-posterior-superior\" or \"3D-right-handed\"");
    } else if (field == "space dimension") {
      if (value != "3") Fail(fmt::format("space dimension is {}; it must be 3", value));
    } else if (field == "space directions") {
      directions_ = VectorsOf(value);
      if (directions_.size() != 3) {
        Fail(fmt::format("space directions are \"{}\"; they must be three vectors (x,y,z)", value));
      }
      directions_line_ = line_;
    } else if (field == "spacings" || field == "axis mins" || field == "axis maxs") {
      TakeAlongAxes(field, value);
    } else {
      return false;
    }
    return true;
  }

  // Reads the spacing of the samples, or the positions of the first and the last sample; no axis
  // may run backwards.
  void TakeAlongAxes(const std::string& field, const std::string& value) {
    const std::vector<std::string_view> words = WordsOf(value);
    if (words.size() != 3) Fail(fmt::format("{} are \"{}\"; they must be three", field, value));
    std::array<double, 3>& numbers = along_[field];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<double> number = ParseNumber(words[axis]);
      if (!number) Fail(fmt::format("{} are \"{}\"; they must be numbers", field, value));
      numbers[axis] = *number;
      const bool is_backward = field == "spacings"
                                   ? numbers[axis] < 0.0
                                   : along_.count("axis mins") * along_.count("axis maxs") > 0 &&
                                         along_["axis mins"][axis] > along_["axis maxs"][axis];
      if (is_backward) {
        Fail(fmt::format("{} are \"{}\": axis {} runs backwards; space directions can turn it",
                         field, value, axis + 1));
      }
    }
  }

  void TakeSizes(const std::string& value) {
    const std::vector<std::string_view> words = WordsOf(value);
    bool is_good = words.size() == 3;
    for (std::size_t axis = 0; is_good && axis < 3; ++axis) {
      const std::optional<int> size = ParseWholeNumber(words[axis]);
      is_good = size.has_value();
      header_.size[axis] = size.value_or(0);
    }
    if (!is_good) Fail(fmt::format("sizes are \"{}\"; they must be three", value));
  }

  int Skip(const std::string& field, const std::string& value, int least) {
    const std::optional<int> count = ParseWholeNumber(value);
    if (!count || *count < least) {
      Fail(fmt::format("{} is \"{}\"; it must be a whole number, {} or more", field, value, least));
    }
    return *count;
  }

  template <typename Value, std::size_t kCount>
  Value Among(const Word<Value> (&words)[kCount], const std::string& field,
              const std::string& value, const char* known) {
    for (const Word<Value>& word : words) {
      if (LowerCase(value) == word.name) return word.value;
    }
    Fail(fmt::format("{} is \"{}\"; it must be {}", field, value, known));
  }

  void RequireWords(const std::string& field, const std::string& value,
                    std::initializer_list<const char*> known, const char* named) {
    const std::string lower = LowerCase(value);
    for (const std::string_view word : WordsOf(lower)) {
      if (std::find(known.begin(), known.end(), word) != known.end()) continue;
      Fail(fmt::format("{} are \"{}\"; they must be {}", field, value, named));
    }
  }

  // Each axis of the file must run along a different axis of space.
  void Orient() {
    if (directions_.empty()) return;
    std::set<std::size_t> taken;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::array<double, 3>& v = directions_[axis];
      const auto largest = static_cast<std::size_t>(
          std::max_element(v.begin(), v.end(),
                           [](double a, double b) { return std::abs(a) < std::abs(b); }) -
          v.begin());
      header_.space_axis[axis] = largest;
      header_.is_reversed[axis] = (v[largest] < 0.0) != space_[largest];
      taken.insert(largest);
      if (!IsAlong(v, largest)) FailOblique();
    }
    if (taken.size() != 3) FailOblique();
  }
  static bool IsAlong(const std::array<double, 3>& v, std::size_t axis) {
    constexpr double kRounding = 1e-6;
    const double length = std::abs(v[axis]);
    return length > 0.0 && std::isfinite(length) &&
           std::hypot(v[(axis + 1) % 3], v[(axis + 2) % 3]) <= kRounding * length;
  }
  [[noreturn]] void FailOblique() {
    line_ = directions_line_;
    Fail(
        "space directions are oblique; each must lie along another axis of space (a volume is "
        "turned by its heading)");
  }

  [[noreturn]] void Fail(const std::string& fault) const {
    throw InputError(fmt::format("{}:{}: {}", file_.string(), line_, fault));
  }

  const fs::path& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0, directions_line_ = 0;
  std::set<std::string> seen_;
  std::array<bool, 3> space_{};
  std::map<std::string, std::array<double, 3>> along_;  // keyed by field name
  std::vector<std::array<double, 3>> directions_;
  NrrdHeader header_;
};

std::string BytesAfter(const fs::path& file, std::size_t begin) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(error ? 0 : size - std::min<std::uintmax_t>(size, begin), '\0');
  stream.seekg(static_cast<std::streamoff>(begin));
  if (error || !stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw InputError("cannot be read");
  return bytes;
}

/// Returns the number of bytes of the values.
std::size_t StoredBytesOf(const NrrdHeader& header) {
  std::size_t bytes = header.type == NrrdHeader::Type::kFloat ? 4 : 1;
  for (const int side : header.size) bytes *= static_cast<std::size_t>(side);
  return bytes;
}

float FloatAt(const char* bytes, bool is_big_endian) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    bits = bits << 8U | static_cast<unsigned char>(bytes[is_big_endian ? i : 3 - i]);
  }
  return std::bit_cast<float>(bits);
}

VolumeGrid FromBytes(const NrrdHeader& header, std::string_view data, GridValues allowed) {
  const std::array<int, 3>& size = header.size;
  const bool is_float = header.type == NrrdHeader::Type::kFloat;
  const std::size_t bytes = StoredBytesOf(header);
  if (data.size() != bytes) {
    throw InputError(fmt::format("{} bytes of data; {} x {} x {} {} are {}", data.size(), size[0],
                                 size[1], size[2], is_float ? "floats" : "bytes", bytes));
  }
  std::vector<float> values(is_float ? bytes / 4 : bytes);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = is_float ? FloatAt(data.data() + 4 * i, header.is_big_endian)
                         : static_cast<float>(static_cast<unsigned char>(data[i])) / 255.0F;
  }
  return {size, std::move(values), allowed};
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
    bool is_whole = packed.empty();
    while (written < most && read < packed.size()) {
      stream_.next_in = reinterpret_cast<Bytef*>(packed.data() + read);
      stream_.next_out = reinterpret_cast<Bytef*>(data.data() + written);
      const uInt in = stream_.avail_in = Piece(packed.size() - read);
      const uInt out = stream_.avail_out = Piece(most - written);
      const int status = inflate(&stream_, Z_NO_FLUSH);
      read += in - stream_.avail_in;
      written += out - stream_.avail_out;
      is_whole = status == Z_STREAM_END;
      if (is_whole) {  // another member can follow
        inflateReset(&stream_);
      } else if (status != Z_OK) {
        throw InputError(fmt::format("the gzip data are damaged at byte {}", read));
      }
    }
    if (!is_whole && written < most)
      throw InputError(fmt::format("the gzip data are cut off at byte {}", read));
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
  const std::size_t wanted = StoredBytesOf(header);
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
VolumeGrid InSpace(const NrrdHeader& header, const VolumeGrid& grid, GridValues allowed) {
  if (header.space_axis == std::array<std::size_t, 3>{0, 1, 2} &&
      header.is_reversed == std::array<bool, 3>{})
    return grid;
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
  return {size, std::move(values), allowed};
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

NrrdHeader ReadNrrdHeader(const fs::path& file) {
  const std::string text = FirstBytes(file);
  const std::optional<FileFormat> format = FormatOfFile(file);
  if (format && !text.starts_with("NRRD000")) RefuseFormat(file, *format, kVolumesWanted);
  return HeaderReader(file, text).Header();
}

VolumeGrid ReadNrrd(const fs::path& file, GridValues allowed) {
  const NrrdHeader header = ReadNrrdHeader(file);
  return NamingItsFile(header.data_file, [&] {
    CheckGridSize(header.size);
    return InSpace(header, FromBytes(header, DataOf(header), allowed), allowed);
  });
}

VolumeGrid ReadRawGrid(const fs::path& file, const std::array<int, 3>& size, GridValues allowed) {
  NrrdHeader header;
  header.size = size;
  std::error_code error;
  if (fs::file_size(file, error) != StoredBytesOf(header)) RefuseKnownFormats(file, kVolumesWanted);
  return NamingItsFile(file, [&] {
    CheckGridSize(size);
    return FromBytes(header, BytesAfter(file, 0), allowed);
  });
}

}  // namespace alpenglow::renderer
