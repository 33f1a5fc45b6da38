// SPDX-License-Identifier: MIT
#include "renderer/series/picture_sequence.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/cli/output_file.h"
#include "lut/cli/program.h"

extern char** environ;

namespace alpenglow::renderer {
namespace {

constexpr int kGap = 8;
constexpr int kGlyphWidth = 3;
constexpr int kGlyphHeight = 5;
constexpr int kGlyphScale = 3;
constexpr int kLabelHeight = kGlyphHeight * kGlyphScale + 6;
constexpr std::uint8_t kPaper = 24;
constexpr std::uint8_t kInk = 200;

/// Returns five rows of three pixels, top row first, '#' for ink; empty for unsupported characters.
std::string_view Glyph(char c) {
  switch (c) {
    case '0':
      return "####.##.##.####";
    case '1':
      return ".#.##..#..#.###";
    case '2':
      return "###..#####..###";
    case '3':
      return "###..####..####";
    case '4':
      return "#.##.####..#..#";
    case '5':
      return "####..###..####";
    case '6':
      return "####..####.####";
    case '7':
      return "###..#.#..#..#.";
    case '8':
      return "####.#####.####";
    case '9':
      return "####.####..####";
    case ':':
      return "....#.....#....";
    case '.':
      return ".............#.";
    case '+':
      return "....#.###.#....";
    case '-':
      return "......###......";
    default:
      return "...............";
  }
}

class Sheet {
 public:
  Sheet(int width, int height)
      : image_{
            width, height,
            std::vector<std::uint8_t>(
                3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kPaper)} {}

  void Paste(const DisplayImage& picture, int left, int top) {
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(picture.width);
    for (int y = 0; y < picture.height; ++y) {
      const auto from = picture.rgb.begin() +
                        static_cast<std::ptrdiff_t>(row_bytes * static_cast<std::size_t>(y));
      std::copy_n(from, row_bytes,
                  image_.rgb.begin() + static_cast<std::ptrdiff_t>(Index(left, top + y)));
    }
  }

  void Print(std::string_view text, int left, int top) {
    for (const char c : text) {
      Draw(Glyph(c), left, top);
      left += (kGlyphWidth + 1) * kGlyphScale;
    }
  }

  [[nodiscard]] const DisplayImage& image() const { return image_; }

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                static_cast<std::size_t>(x));
  }
  void Draw(std::string_view glyph, int left, int top) {
    for (int y = 0; y < kGlyphHeight * kGlyphScale; ++y) {
      for (int x = 0; x < kGlyphWidth * kGlyphScale; ++x) {
        const int cell = y / kGlyphScale * kGlyphWidth + x / kGlyphScale;
        const bool inside = left + x < image_.width && top + y < image_.height;
        if (!inside || glyph[static_cast<std::size_t>(cell)] != '#') continue;
        std::fill_n(image_.rgb.begin() + static_cast<std::ptrdiff_t>(Index(left + x, top + y)), 3,
                    kInk);
      }
    }
  }

  DisplayImage image_;
};

/// Returns the mean of the pixels [x0, x1) x [y0, y1).
std::array<float, 3> Mean(const Image& image, int x0, int x1, int y0, int y1) {
  std::array<double, 3> sum = {};
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(image.at(x, y)[c]);
    }
  }
  const double pixels = static_cast<double>(x1 - x0) * (y1 - y0);
  return {static_cast<float>(sum[0] / pixels), static_cast<float>(sum[1] / pixels),
          static_cast<float>(sum[2] / pixels)};
}

}  // namespace

Image Reduced(const Image& image, int width) {
  const int columns = std::min(width, image.width);
  const int rows = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(image.height) * columns / image.width)));
  Image reduced(columns, rows);
  for (int y = 0; y < rows; ++y) {
    const auto y0 = static_cast<int>(static_cast<std::int64_t>(y) * image.height / rows);
    const auto y1 = static_cast<int>(static_cast<std::int64_t>(y + 1) * image.height / rows);
    for (int x = 0; x < columns; ++x) {
      const auto x0 = static_cast<int>(static_cast<std::int64_t>(x) * image.width / columns);
      const auto x1 = static_cast<int>(static_cast<std::int64_t>(x + 1) * image.width / columns);
      reduced.at(x, y) = Mean(image, x0, x1, y0, y1);
    }
  }
  return reduced;
}

DisplayImage ContactSheet(const std::vector<Thumbnail>& thumbnails) {
  ALPENGLOW_ENSURE(thumbnails.size(), >, 0U);
  const auto count = static_cast<int>(thumbnails.size());
  const auto columns = static_cast<int>(std::ceil(std::sqrt(count)));
  const int rows = (count + columns - 1) / columns;
  const int cell_width = thumbnails[0].image.width + kGap;
  const int cell_height = thumbnails[0].image.height + kLabelHeight + kGap;
  Sheet sheet(columns * cell_width + kGap, rows * cell_height + kGap);
  for (int i = 0; i < count; ++i) {
    const Thumbnail& thumbnail = thumbnails[static_cast<std::size_t>(i)];
    ALPENGLOW_ENSURE(thumbnail.image.width, ==, thumbnails[0].image.width);
    ALPENGLOW_ENSURE(thumbnail.image.height, ==, thumbnails[0].image.height);
    const int left = kGap + i % columns * cell_width;
    const int top = kGap + i / columns * cell_height;
    sheet.Paste(thumbnail.image, left, top);
    sheet.Print(thumbnail.label, left, top + thumbnail.image.height + 3);
  }
  return sheet.image();
}

void Keogram::Add(const DisplayImage& picture) {
  if (rgb_.empty()) height_ = picture.height;
  ALPENGLOW_ENSURE(picture.height, ==, height_);
  for (int y = 0; y < height_; ++y) {
    const auto pixel =
        picture.rgb.begin() + 3 * (std::ptrdiff_t{y} * picture.width + picture.width / 2);
    rgb_.insert(rgb_.end(), pixel, pixel + 3);
  }
}

DisplayImage Keogram::Image() const {
  ALPENGLOW_ENSURE(rgb_.size(), >, 0U);
  const auto height = static_cast<std::size_t>(height_);
  const std::size_t width = rgb_.size() / (3 * height);
  DisplayImage image{static_cast<int>(width), height_, std::vector<std::uint8_t>(rgb_.size())};
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t y = 0; y < height; ++y) {
      std::copy_n(&rgb_[3 * (x * height + y)], 3, &image.rgb[3 * (y * width + x)]);
    }
  }
  return image;
}

namespace {

namespace fs = std::filesystem;

std::optional<fs::path> OnPath(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::string_view folders = path == nullptr ? "" : path;
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(std::min(folder.size() + 1, folders.size()));
    const fs::path candidate = fs::path(folder.empty() ? "." : folder) / program;
    if (fs::is_regular_file(candidate) && access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return std::nullopt;
}

fs::path Ffmpeg() {
  const std::optional<fs::path> program = OnPath("ffmpeg");
  if (!program) throw OutputError("a film needs ffmpeg, which is not on the PATH");
  return *program;
}

std::string CommentOf(const Metadata& metadata) {
  std::string comment = ProducerText();
  for (const auto& [name, value] : metadata) comment += fmt::format("; {}={}", name, value);
  return comment;
}

std::vector<std::string> ArgumentsOf(const fs::path& file, const VideoSettings& settings) {
  std::vector<std::string> arguments{
      "ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
      // Input.
      "-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size",
      fmt::format("{}x{}", settings.width, settings.height), "-framerate",
      fmt::format("{}", settings.frames_per_s), "-i", "pipe:0",
      // Output: 4:2:0 needs even sides.
      "-vf",
      "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
      "-c:v", "libx264", "-crf", "17", "-colorspace", "bt709", "-color_primaries", "bt709",
      "-color_trc", "iec61966-2-1", "-color_range", "tv", "-metadata",
      "comment=" + CommentOf(settings.metadata)};
  if (!HasExtension(file, ".mkv")) {
    arguments.insert(arguments.end(), {"-movflags", "+faststart"});
  }
  arguments.push_back("file:" + file.string());
  return arguments;
}

/// An ffmpeg process that reads frames from a socket: sending to a socket fails without a signal
/// when the process has ended. The destructor kills the process.
class Encoder {
 public:
  Encoder(const fs::path& program, std::vector<std::string> arguments)
      : said_(memfd_create("alpenglow_ffmpeg", MFD_CLOEXEC)) {
    if (!said_.valid()) throw OutputError("ffmpeg cannot report: " + LastSystemError());
    std::array<int, 2> ends{-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      throw OutputError("ffmpeg cannot be fed: " + LastSystemError());
    }
    feed_ = Descriptor(ends[0]);
    const Descriptor its_end(ends[1]);
    Spawn(program, std::move(arguments), its_end.number());
  }
  ~Encoder() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    static_cast<void>(Wait());
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  void Take(const std::vector<std::uint8_t>& bytes) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t count =
          send(feed_.number(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) Finish();  // the process has ended and reports the reason
      if (count <= 0) throw OutputError("ffmpeg ended before the film did");
      sent += static_cast<std::size_t>(count);
    }
  }

  /// Ends the film. Throws OutputError if ffmpeg failed.
  void Finish() {
    feed_ = Descriptor(-1);
    const int status = Wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
      throw OutputError("ffmpeg: " + LastWords());
    }
  }

 private:
  // Uses a separate process group: Ctrl-C reaches only this program, which then ends ffmpeg.
  void Spawn(const fs::path& program, std::vector<std::string> arguments, int its_end) {
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, its_end, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, said_.number(), STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error =
        posix_spawn(&process_, program.c_str(), &files, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (error == 0) return;
    process_ = 0;
    throw OutputError("ffmpeg cannot be started: " + std::generic_category().message(error));
  }

  int Wait() {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    return status;
  }

  [[nodiscard]] std::string LastWords() const {
    constexpr off_t kMost = 4096;
    const off_t end = lseek(said_.number(), 0, SEEK_END);
    std::string text(static_cast<std::size_t>(std::clamp<off_t>(end, 0, kMost)), '\0');
    const ssize_t count =
        pread(said_.number(), text.data(), text.size(), end - static_cast<off_t>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    const std::string_view lines = Trimmed(text);
    if (lines.empty()) return "it gives no reason";
    return std::string(lines.substr(lines.find_last_of('\n') + 1));
  }

  Descriptor said_;  // its standard error, in memory: no folder for temporary files is needed
  Descriptor feed_{-1};
  pid_t process_ = 0;
};

}  // namespace

void RequireVideo(const fs::path& file) {
  constexpr std::array<std::string_view, 3> kKinds{".mp4", ".mov", ".mkv"};
  const auto is_of = [&](std::string_view kind) { return HasExtension(file, kind); };
  if (std::none_of(kKinds.begin(), kKinds.end(), is_of)) {
    throw OptionError(
        fmt::format("\"{}\" is no film's name; it must end in .mp4, .mov or .mkv", file.string()));
  }
  static_cast<void>(Ffmpeg());
}

void WriteVideo(const fs::path& file, const VideoSettings& settings, int frames,
                const std::function<DisplayImage(int)>& frame) {
  RequireVideo(file);
  WriteFileAtomically(file, [&](const fs::path& temporary) {
    Encoder encoder(Ffmpeg(), ArgumentsOf(temporary, settings));
    for (int number = 0; number < frames; ++number) {
      ThrowIfInterrupted();
      const DisplayImage image = frame(number);
      ALPENGLOW_ENSURE(image.width, ==, settings.width);
      ALPENGLOW_ENSURE(image.height, ==, settings.height);
      encoder.Take(image.rgb);
    }
    encoder.Finish();
  });
}

}  // namespace alpenglow::renderer
