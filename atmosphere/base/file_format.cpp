// SPDX-License-Identifier: MIT
#include "atmosphere/base/file_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::size_t at;  // bytes before the magic ones
  std::string_view magic;
  const char* name;
  const char* advice = "";
};

constexpr const char* kUnzip = "unzip it and name a file in it";
constexpr const char* kConvertToGpx = "convert it to GPX";
constexpr const char* kUnpack = "decompress it";
constexpr const char* kSaveAsUtf8 = "save it as UTF-8";

constexpr Signature kBinary[] = {
    {0, "PK\x03\x04"sv, "a zip archive (KMZ, NPZ, XLSX and USDZ files are zip archives)", kUnzip},
    {0, "PK\x05\x06"sv, "an empty zip archive"},
    {0, "\x1F\x8B"sv, "gzip-compressed", kUnpack},
    {0, "BZh"sv, "bzip2-compressed", kUnpack},
    {0, "\xFD\x37zXZ\0"sv, "xz-compressed", kUnpack},
    {0, "\x28\xB5\x2F\xFD"sv, "zstd-compressed", kUnpack},
    {0, "7z\xBC\xAF\x27\x1C"sv, "a 7-Zip archive", kUnpack},
    {0, "Rar!\x1A\x07"sv, "a RAR archive", kUnpack},
    {257, "ustar"sv, "a tar archive", kUnpack},
    {0, "\x89PNG\r\n\x1A\n"sv, "a PNG picture"},
    {0, "\xFF\xD8\xFF"sv, "a JPEG picture"},
    {0, "\0\0\0\x0CjP  "sv, "a JPEG 2000 picture"},
    {0, "\xFF\x4F\xFF\x51"sv, "a JPEG 2000 picture"},
    {0, "GIF8"sv, "a GIF picture"},
    {0, "II*\0"sv, "TIFF"},
    {0, "MM\0*"sv, "TIFF"},
    {0, "II+\0"sv, "TIFF"},
    {0, "MM\0+"sv, "TIFF"},
    {0, "\x76\x2F\x31\x01"sv, "an OpenEXR picture"},
    {0, "#?RADIANCE"sv, "a Radiance picture"},
    {0, "EHFA_HEADER_TAG"sv, "ERDAS Imagine"},
    {0, "%PDF-"sv, "PDF"},
    {0, "glTF"sv, "binary glTF (GLB), a mesh"},
    {0, "Kaydara FBX Binary"sv, "FBX, a mesh"},
    {0, "BLENDER"sv, "a Blender file"},
    {0, "PXR-USDC"sv, "USD, a scene"},
    {0, "Ogawa"sv, "Alembic, a scene"},
    {0, "LASF"sv, "LAS, a point cloud"},
    {0, "ASTM-E57"sv, "E57, a point cloud"},
    {0, " BDV\0\0\0\0"sv, "OpenVDB"},
    {0, "NanoVDB"sv, "NanoVDB"},
    {0, "\x93NUMPY"sv, "a NumPy array (.npy)"},
    {0, "VOL\x03"sv, "a Mitsuba volume"},
    {344, "n+1\0"sv, "NIfTI"},
    {128, "DICM"sv, "DICOM"},
    {0, "\x89HDF\r\n\x1A\n"sv, "HDF5 or NetCDF-4"},
    {0, "\x0E\x03\x13\x01"sv, "HDF4"},
    {0, "CDF\x01"sv, "NetCDF"},
    {0, "CDF\x02"sv, "NetCDF"},
    {0, "CDF\x05"sv, "NetCDF"},
    {0, "GRIB"sv, "GRIB"},
    {0, "SQLite format 3\0"sv, "SQLite (GeoPackage and MBTiles are such)"},
    {0, "\xD0\xCF\x11\xE0"sv, "an Office document"},
    {0, "\x7F\x45LF"sv, "a program"}};

constexpr Signature kText[] = {{0, "\xFF\xFE"sv, "UTF-16 text", kSaveAsUtf8},
                               {0, "\xFE\xFF"sv, "UTF-16 text", kSaveAsUtf8},
                               {0, "ply\n"sv, "PLY, a mesh or a point cloud"},
                               {0, "ply\r"sv, "PLY, a mesh or a point cloud"},
                               {0, "OFF\n"sv, "OFF, a mesh"},
                               {0, "OFF\r"sv, "OFF, a mesh"},
                               {0, "; FBX"sv, "FBX, a mesh"},
                               {0, "#usda"sv, "USD, a scene"},
                               {0, "#VRML"sv, "VRML, a scene"},
                               {0, "NRRD000"sv, "NRRD"},
                               {0, "ObjectType ="sv, "MetaImage (.mhd)"},
                               {0, "NDims ="sv, "MetaImage (.mhd)"},
                               {0, "# vtk DataFile"sv, "VTK"},
                               {0, "IESNA"sv, "IES photometry"},
                               {0, "DSAA"sv, "a Surfer grid"},
                               {0, "ncols "sv, "an Arc/Info ASCII grid (.asc)"},
                               {0, "NCOLS "sv, "an Arc/Info ASCII grid (.asc)"},
                               {0, "HFDTE"sv, "IGC, a track", kConvertToGpx},
                               {0, "$GP"sv, "NMEA, a track", kConvertToGpx},
                               {0, "$GN"sv, "NMEA, a track", kConvertToGpx}};

struct XmlRoot {
  std::string_view root;  // without its namespace
  const char* name;
  const char* advice = "";
};

constexpr XmlRoot kXmlRoots[] = {{"gpx", "GPX, a track"},
                                 {"kml", "KML, a track"},
                                 {"TrainingCenterDatabase", "TCX, a track", kConvertToGpx},
                                 {"COLLADA", "COLLADA, a mesh"},
                                 {"X3D", "X3D, a scene"},
                                 {"VTKFile", "VTK"},
                                 {"VRTDataset", "a virtual raster (VRT)"},
                                 {"svg", "an SVG picture"},
                                 {"html", "an HTML page"}};

FileFormat Found(std::string_view name, std::string_view advice, bool is_text) {
  return {std::string(name), std::string(advice), is_text};
}

std::string_view WithoutBlanks(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return text;
}

/// Returns the name of the first element after the declaration and comments of XML, without its
/// namespace; empty for another text.
std::string_view RootOfXml(std::string_view text) {
  while (text.starts_with("<?") || text.starts_with("<!")) {
    const std::string_view end = text.starts_with("<!--") ? "-->" : ">";
    if (text.substr(0, 9) == "<!DOCTYPE" && text.substr(9, 5) == " html") return "html";
    const std::size_t at = text.find(end);
    if (at == std::string_view::npos) return {};
    text = WithoutBlanks(text.substr(at + end.size()));
  }
  if (!text.starts_with('<')) return {};
  text.remove_prefix(1);
  text = text.substr(0, text.find_first_of(" \t\r\n/>"));
  return text.substr(text.find(':') == std::string_view::npos ? 0 : text.find(':') + 1);
}

std::optional<FileFormat> XmlFormat(std::string_view text) {
  const std::string_view root = RootOfXml(text);
  for (const XmlRoot& known : kXmlRoots) {
    if (root == known.root) return Found(known.name, known.advice, true);
  }
  if (!root.empty()) return Found(fmt::format("XML with the root <{}>", root), "", true);
  if (text.starts_with("<?xml")) return Found("XML", "", true);
  return std::nullopt;
}

// A table of TOML may also begin with a bracket, a brace or bracket within it may not.
std::optional<FileFormat> JsonFormat(std::string_view text) {
  const bool is_list = text.starts_with('[') && WithoutBlanks(text.substr(1)).starts_with('{');
  if (!text.starts_with('{') && !is_list) return std::nullopt;
  const auto has = [&](std::string_view word) { return text.find(word) != text.npos; };
  if (has("\"asset\"") && has("\"version\"")) return Found("glTF, a mesh", "", true);
  if (has("\"FeatureCollection\"") || has("\"Feature\"")) return Found("GeoJSON", "", true);
  return Found("JSON", "", true);
}

/// Returns whether the bytes are a binary STL file: its header ends with the number of triangles.
bool IsBinaryStl(std::string_view bytes, std::uint64_t file_bytes) {
  constexpr std::size_t kHeader = 80, kTriangle = 50;
  if (bytes.size() < kHeader + 4) return false;
  std::uint64_t triangles = 0;
  for (std::size_t i = 4; i-- > 0;)
    triangles = triangles << 8U | static_cast<unsigned char>(bytes[kHeader + i]);
  return triangles > 0 && file_bytes == kHeader + 4 + kTriangle * triangles;
}

std::optional<FileFormat> StlFormat(std::string_view bytes, std::uint64_t file_bytes) {
  const bool is_text =
      WithoutBlanks(bytes).starts_with("solid") && bytes.find("facet") != std::string_view::npos;
  if (!is_text && !IsBinaryStl(bytes, file_bytes)) return std::nullopt;
  return Found("STL, a mesh", "", is_text);
}

/// Formats with their name at byte 8, where a text may have any word, and a number or another name
/// before it.
std::optional<FileFormat> FormatNamedAtByte8(std::string_view bytes) {
  if (bytes.size() < 12) return std::nullopt;
  const std::string_view name = bytes.substr(8, 4);
  if (bytes.starts_with("RIFF") && name == "WEBP") return Found("a WebP picture", "", false);
  const bool has_fit_header = bytes[0] == 12 || bytes[0] == 14;  // bytes of the header
  if (has_fit_header && name == ".FIT") return Found("FIT, a track", kConvertToGpx, false);
  return std::nullopt;
}

// Records of IGC follow a line with the recorder's name.
bool IsIgc(std::string_view text) {
  return text.starts_with('A') && text.find("\nHFDTE") != std::string_view::npos;
}

std::optional<FileFormat> Among(const Signature* first, const Signature* last,
                                std::string_view bytes, bool is_text) {
  const Signature* found = std::find_if(first, last, [&](const Signature& known) {
    return bytes.size() > known.at && bytes.substr(known.at).starts_with(known.magic);
  });
  if (found == last) return std::nullopt;
  return Found(found->name, found->advice, is_text);
}

}  // namespace

std::optional<FileFormat> FormatOf(std::string_view first_bytes, std::uint64_t file_bytes) {
  if (auto found = Among(std::begin(kBinary), std::end(kBinary), first_bytes, false)) return found;
  if (auto found = FormatNamedAtByte8(first_bytes)) return found;
  if (auto found = StlFormat(first_bytes, file_bytes)) return found;
  const std::string_view text = WithoutBlanks(first_bytes);
  if (auto found = Among(std::begin(kText), std::end(kText), text, true)) return found;
  if (IsIgc(text)) return Found("IGC, a track", kConvertToGpx, true);
  if (auto found = XmlFormat(text)) return found;
  return JsonFormat(text);
}

std::optional<FileFormat> FormatOfFile(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  const std::uint64_t file_bytes = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(kFormatBytes, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return FormatOf(bytes, file_bytes);
}

void RefuseFormat(const std::filesystem::path& file, const FileFormat& format,
                  std::string_view wanted) {
  RefuseFile(file, fmt::format("this is {}; {}{}{}", format.name, wanted,
                               format.advice.empty() ? "" : ": ", format.advice));
}

void RefuseKnownFormats(const std::filesystem::path& file, std::string_view wanted) {
  if (const std::optional<FileFormat> format = FormatOfFile(file))
    RefuseFormat(file, *format, wanted);
}

}  // namespace alpenglow::atmosphere
