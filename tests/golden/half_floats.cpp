// SPDX-License-Identifier: MIT
// Copies an EXR picture with R, G and B as half floats, which have 11 bits, and with compression
// PIZ. The golden pictures are stored in this form: it takes 30 % of the bytes of float.
//   half_floats FROM TO
// The text attributes of the header are copied; layers besides R, G and B are omitted.
#include <ImfRgbaFile.h>

#include <cstdio>
#include <exception>
#include <vector>

namespace {

void Copy(const char* from, const char* to) {
  Imf::RgbaInputFile picture(from);
  const int width = picture.dataWindow().max.x + 1, height = picture.dataWindow().max.y + 1;
  std::vector<Imf::Rgba> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  picture.setFrameBuffer(pixels.data(), 1, static_cast<std::size_t>(width));
  picture.readPixels(0, height - 1);
  Imf::Header header = picture.header();
  header.compression() = Imf::PIZ_COMPRESSION;
  Imf::RgbaOutputFile copy(to, header, Imf::WRITE_RGB);
  copy.setFrameBuffer(pixels.data(), 1, static_cast<std::size_t>(width));
  copy.writePixels(height);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: half_floats FROM TO\n", stderr);
    return 2;
  }
  try {
    Copy(arguments[1], arguments[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "half_floats: %s\n", error.what());
    return 1;
  }
  return 0;
}
