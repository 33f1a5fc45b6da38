// SPDX-License-Identifier: MIT
#include "renderer/series/video.h"

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
