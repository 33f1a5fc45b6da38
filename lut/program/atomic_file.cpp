// SPDX-License-Identifier: MIT
#include "lut/program/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <random>
#include <regex>
#include <string>
#include <system_error>

#include "atmosphere/text/error.h"
#include "lut/layer.h"
#include "lut/program/descriptor.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const fs::path& target, const std::string& fault) {
  throw OutputError(fmt::format("{}: {}", target.string(), fault));
}

// FNV-1a (Fowler, Noll and Vo): names of machines as eight digits, whatever they are made of.
std::uint32_t Hash(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash;
}

/// "machine" as it stands in the names of temporaries.
std::string MachineText() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return fmt::format("{:08x}", Hash(name.data()));
}

/// A name in the target's folder that no other process and no other thread uses:
/// .STEM.MACHINE-PROCESS-RUN-COUNT.part.EXTENSION. It is hidden, so that patterns like
/// "frame.*.exr" do not find it, and keeps the extension, by which libraries choose formats.
fs::path TemporaryName(const fs::path& target) {
  constexpr std::size_t kLongestStem = 100;            // names have at most 255 bytes
  static const unsigned run = std::random_device{}();  // processes of equal numbers (containers)
  static std::atomic<unsigned> count{0};
  return target.parent_path() /
         fmt::format(".{}.{}-{}-{:08x}-{}.part{}", target.stem().string().substr(0, kLongestStem),
                     MachineText(), getpid(), run, count++, target.extension().string());
}

/// Whether the name is one that TemporaryName gives on this machine.
bool IsTemporaryOfThisMachine(const std::string& name) {
  static const std::regex form(R"(\..*\.([0-9a-f]{8})-[0-9]+-[0-9a-f]{8}-[0-9]+\.part(\..*)?)");
  std::smatch match;
  return std::regex_match(name, match, form) && match[1] == MachineText();
}

/// Creates the file and locks it. Not by mkstemp, whose files are private to the user whatever the
/// umask says. @return its descriptor, negative when it cannot be created.
int CreateLocked(const fs::path& name) {
  for (;;) {
    const int file = open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file < 0) return file;
    while (flock(file, LOCK_EX) != 0 && errno == EINTR) {
    }
    std::error_code error;
    if (fs::exists(name, error)) return file;
    close(file);  // was taken for abandoned before it was locked
  }
}

/// A file that goes with the object, locked as long as it lives: RemoveAbandonedTemporaries.
class Temporary {
 public:
  explicit Temporary(const fs::path& target)
      : name_(TemporaryName(target)), file_(CreateLocked(name_)) {
    if (!file_.valid()) Fail(target, "cannot be written: " + LastSystemError());
  }
  ~Temporary() {
    std::error_code ignored;
    fs::remove(name_, ignored);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  [[nodiscard]] const fs::path& name() const { return name_; }

 private:
  fs::path name_;
  Descriptor file_;
};

/// Removes a temporary that no process holds locked, itself holding the lock meanwhile.
bool RemoveIfAbandoned(const fs::path& temporary) {
  const Descriptor file(open(temporary.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.valid() || flock(file.number(), LOCK_EX | LOCK_NB) != 0) return false;
  std::error_code error;
  return fs::remove(temporary, error);
}

void FlushToDisk(const fs::path& file, const fs::path& target) {
  const Descriptor descriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!descriptor.valid() || fsync(descriptor.number()) != 0) {
    Fail(target, "cannot be written: " + LastSystemError());
  }
}

void CallWriter(const fs::path& target, const fs::path& temporary,
                const std::function<void(const fs::path&)>& write) {
  const auto rethrow = [&](std::string fault) {
    const std::string hidden = temporary.string();
    if (const std::size_t at = fault.find(hidden); at != std::string::npos) {
      throw OutputError(fault.replace(at, hidden.size(), target.string()));
    }
    Fail(target, fault);
  };
  try {
    write(temporary);
  } catch (const OutputError& error) {
    rethrow(error.what());
  } catch (const fs::filesystem_error& error) {
    rethrow(error.code().message());
  }
}

}  // namespace

fs::path FinalName(const fs::path& target) {
  constexpr int kMostLinks = 40;  // as the kernel
  std::error_code error;
  fs::path real = target;
  for (int links = 0; links < kMostLinks && fs::is_symlink(real, error); ++links) {
    real = real.parent_path() / fs::read_symlink(real, error);
  }
  if (real.filename().empty()) Fail(target, "is not the name of a file");
  const fs::file_status status = fs::status(real, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) Fail(target, "is not a regular file");
  return real;
}

void WriteFileAtomically(const fs::path& target,
                         const std::function<void(const fs::path&)>& write) {
  const fs::path real = FinalName(target);
  const Temporary temporary(real);
  CallWriter(target, temporary.name(), write);
  FlushToDisk(temporary.name(), target);
  std::error_code error;
  fs::rename(temporary.name(), real, error);
  if (error) Fail(target, "cannot be written: " + error.message());
  // The name itself reaches the disk with its folder; a folder that cannot be opened for reading
  // has the file all the same.
  const fs::path folder = real.has_parent_path() ? real.parent_path() : fs::path(".");
  const Descriptor descriptor(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor.valid()) fsync(descriptor.number());
}

void WriteTextAtomically(const fs::path& target, std::string_view text) {
  WriteFileAtomically(target, [&](const fs::path& name) {
    std::ofstream file(name, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) throw OutputError("cannot be written: " + LastSystemError());
  });
}

void RequireWritable(const fs::path& target) { const Temporary probe(FinalName(target)); }

std::size_t RemoveAbandonedTemporaries(const fs::path& folder) {
  std::size_t removed = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; entry != end;
       entry.increment(error)) {
    const fs::path& file = entry->path();
    if (!IsTemporaryOfThisMachine(file.filename().string())) continue;
    if (RemoveIfAbandoned(file)) ++removed;
  }
  return removed;
}

}  // namespace alpenglow::lut
