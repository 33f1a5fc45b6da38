// SPDX-License-Identifier: MIT
// This file reads and writes PNG through libpng 1.6 (ISO/IEC 15948).
//
// libpng reports errors by longjmp. Functions that it jumps out of are marked; they have no local
// objects with destructors, and take plain pointers.
#include "lut/image/png.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "lut/cli/output_file.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<std::uint8_t>;

/// Message of the error for which libpng jumps.
struct Fault {
  char text[200] = "unknown fault";
};

void RememberFault(png_structp png, png_const_charp text) {
  auto* fault = static_cast<Fault*>(png_get_error_ptr(png));
  std::strncpy(fault->text, text, sizeof(fault->text) - 1);
  png_longjmp(png, 1);
}

void IgnoreWarning(png_structp /*png*/, png_const_charp /*text*/) {}

void AppendBytes(png_structp png, png_bytep bytes, png_size_t count) {
  auto* out = static_cast<Bytes*>(png_get_io_ptr(png));
  out->insert(out->end(), bytes, bytes + count);
}

void FlushNothing(png_structp /*png*/) {}

bool IsAscii(const std::string& text) {
  for (const char c : text) {
    if (static_cast<unsigned char>(c) >= 0x80) return false;
  }
  return true;
}

/// Returns text chunks that point into `metadata`: tEXt for ASCII, iTXt (UTF-8) for other text.
std::vector<png_text> TextChunks(const Metadata& metadata) {
  std::vector<png_text> chunks;
  for (const auto& [name, value] : metadata) {
    ALPENGLOW_ENSURE(name.size(), <, 80U);
    png_text chunk = {};
    chunk.compression = IsAscii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(name.c_str());
    chunk.text = const_cast<char*>(value.c_str());
    chunk.text_length = value.size();
    chunks.push_back(chunk);
  }
  return chunks;
}

struct Writer {
  Fault fault;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &fault, RememberFault, IgnoreWarning);
  png_infop info = png_create_info_struct(png);

  Writer() = default;
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
};

struct Reader {
  Fault fault;
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &fault, RememberFault, IgnoreWarning);
  png_infop info = png_create_info_struct(png);

  Reader() = default;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

/// libpng jumps out of this function.
bool Encode(Writer& writer, const DisplayImage& image, png_text* chunks, int chunk_count,
            png_bytepp rows) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  // Skies are smooth and dithered: differences to the left neighbour, and no long search for
  // repetitions, make files of equal size in a quarter of the time.
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(writer.png, 4);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(writer.png, writer.info, chunks, chunk_count);
  png_set_rows(writer.png, writer.info, rows);
  png_write_png(writer.png, writer.info, PNG_TRANSFORM_IDENTITY, nullptr);
  return true;
}

/// libpng jumps out of this function.
bool DecodeHeader(Reader& reader, std::FILE* file) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_init_io(reader.png, file);
  png_read_info(reader.png, reader.info);
  return true;
}

/// libpng jumps out of this function. The rows stay in `info`.
bool DecodePixels(Reader& reader, std::FILE* file) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_user_limits(reader.png, kLargestImageSide, kLargestImageSide);
  png_init_io(reader.png, file);
  png_read_png(reader.png, reader.info,
               PNG_TRANSFORM_STRIP_16 | PNG_TRANSFORM_STRIP_ALPHA | PNG_TRANSFORM_EXPAND |
                   PNG_TRANSFORM_GRAY_TO_RGB,
               nullptr);
  return true;
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File Open(const fs::path& file) {
  File stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) throw InputError(fmt::format("{}: cannot be opened", file.string()));
  return stream;
}

[[noreturn]] void Refuse(const fs::path& file, const Fault& fault) {
  throw InputError(fmt::format("{}: not a readable PNG picture: {}", file.string(), fault.text));
}

}  // namespace

std::string PngBytes(const DisplayImage& image, const Metadata& metadata) {
  std::vector<png_text> chunks = TextChunks(metadata);
  std::vector<png_bytep> rows;
  const std::size_t stride = 3 * static_cast<std::size_t>(image.width);
  ALPENGLOW_ENSURE(image.rgb.size(), ==, stride * static_cast<std::size_t>(image.height));
  for (std::size_t at = 0; at < image.rgb.size(); at += stride) {
    rows.push_back(const_cast<png_bytep>(image.rgb.data() + at));
  }
  Bytes bytes;
  Writer writer;
  png_set_write_fn(writer.png, &bytes, AppendBytes, FlushNothing);
  if (!Encode(writer, image, chunks.data(), static_cast<int>(chunks.size()), rows.data())) {
    throw InternalError(fmt::format("libpng: {}", writer.fault.text));
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void WritePng(const fs::path& file, const DisplayImage& image, const Metadata& metadata) {
  WriteTextAtomically(file, PngBytes(image, metadata));
}

DisplayImage ReadPng(const fs::path& file) {
  const File stream = Open(file);
  Reader reader;
  if (!DecodePixels(reader, stream.get())) Refuse(file, reader.fault);
  DisplayImage image;
  image.width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  image.height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  const std::size_t stride = 3 * static_cast<std::size_t>(image.width);
  const png_bytepp rows = png_get_rows(reader.png, reader.info);
  for (int y = 0; y < image.height; ++y) {
    image.rgb.insert(image.rgb.end(), rows[y], rows[y] + stride);
  }
  return image;
}

Metadata ReadPngMetadata(const fs::path& file) {
  const File stream = Open(file);
  Reader reader;
  if (!DecodeHeader(reader, stream.get())) Refuse(file, reader.fault);
  png_textp chunks = nullptr;
  int count = 0;
  png_get_text(reader.png, reader.info, &chunks, &count);
  Metadata metadata;
  for (int i = 0; i < count; ++i) metadata[chunks[i].key] = chunks[i].text;
  return metadata;
}

}  // namespace alpenglow::lut
