// SPDX-License-Identifier: MIT
#include "lut/cli/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <exception>
#include <fstream>
#include <mutex>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <system_error>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/numerics.h"
#include "lut/cli/outputs.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const fs::path& target, const std::string& fault) {
  throw OutputError(fmt::format("{}: {}", target.string(), fault));
}

/// Returns the "machine" part of the names of temporaries.
std::string MachineText() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  Fnv1a hash;  // reduces names of machines, with any characters, to eight digits
  hash.AddBytes(name.data());
  return fmt::format("{:08x}", static_cast<std::uint32_t>(hash.hash()));
}

/// Returns a name in the target's folder that no other process or thread uses:
/// .STEM.MACHINE-PROCESS-RUN-COUNT.part.EXTENSION. It is hidden, so that patterns like
/// "frame.*.exr" do not match it, and keeps the extension, from which libraries choose the format.
fs::path TemporaryName(const fs::path& target) {
  constexpr std::size_t kLongestStem = 100;            // names have at most 255 bytes
  static const unsigned run = std::random_device{}();  // containers may have equal process numbers
  static std::atomic<unsigned> count{0};
  return target.parent_path() /
         fmt::format(".{}.{}-{}-{:08x}-{}.part{}", target.stem().string().substr(0, kLongestStem),
                     MachineText(), getpid(), run, count++, target.extension().string());
}

/// Returns whether the name has the form that TemporaryName gives on this machine.
bool IsTemporaryOfThisMachine(const std::string& name) {
  static const std::regex form(R"(\..*\.([0-9a-f]{8})-[0-9]+-[0-9a-f]{8}-[0-9]+\.part(\..*)?)");
  std::smatch match;
  return std::regex_match(name, match, form) && match[1] == MachineText();
}

/// Creates the file and locks it. mkstemp is not used, because its files are private to the user
/// whatever the umask is. @return its descriptor, negative if it cannot be created.
int CreateLocked(const fs::path& name) {
  for (;;) {
    const int file = open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file < 0) return file;
    while (flock(file, LOCK_EX) != 0 && errno == EINTR) {
    }
    std::error_code error;
    if (fs::exists(name, error)) return file;
    close(file);  // another process removed it as abandoned before it was locked
  }
}

/// The temporaries that exist, for RemoveTemporariesOfThisProcess.
class Temporaries {
 public:
  void Add(const fs::path& name) {
    const std::lock_guard<std::mutex> lock(mutex_);
    names_.insert(name);
  }
  void Remove(const fs::path& name) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::error_code ignored;
    fs::remove(name, ignored);
    names_.erase(name);
  }
  void RemoveAll() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::error_code ignored;
    for (const fs::path& name : names_) fs::remove(name, ignored);
    names_.clear();
  }
  [[nodiscard]] static Temporaries& OfThisProcess() {
    static Temporaries temporaries;
    return temporaries;
  }

 private:
  std::mutex mutex_;
  std::set<fs::path> names_;
};

/// A file that is deleted with the object, and locked during its lifetime:
/// RemoveAbandonedTemporaries.
class Temporary {
 public:
  explicit Temporary(const fs::path& target)
      : name_(TemporaryName(target)), file_(CreateLocked(name_)) {
    if (!file_.valid()) Fail(target, "cannot be written: " + LastSystemError());
    Temporaries::OfThisProcess().Add(name_);
  }
  ~Temporary() { Temporaries::OfThisProcess().Remove(name_); }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  [[nodiscard]] const fs::path& name() const { return name_; }

 private:
  fs::path name_;
  Descriptor file_;
};

/// Removes a temporary that no process has locked, and holds the lock while doing so.
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
    const std::string hidden = Printable(temporary.string());
    if (const std::size_t at = fault.find(hidden); at != std::string::npos) {
      throw OutputError(fault.replace(at, hidden.size(), Printable(target.string())));
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

// Extensions of known file formats; a folder may be called "tables.v2".
constexpr std::array kExtensionsOfFiles =
    std::to_array<std::string_view>({".bin", ".csv", ".dat", ".dds", ".exr", ".hdr", ".jpg", ".ktx",
                                     ".ktx2", ".npy", ".png", ".tif", ".tiff", ".toml"});

}  // namespace

fs::path FinalName(const fs::path& target) {
  constexpr int kMostLinks = 40;  // limit of the kernel
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
  // Flushing the folder makes the new name durable. If the folder cannot be opened for reading, the
  // file is there nevertheless.
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

void MakeFolder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    throw OutputError(fmt::format("{}: no such folder can be made: {}", folder.string(),
                                  error ? error.message() : "it is a file"));
  }
}

void RequireWritable(const fs::path& target) { const Temporary probe(FinalName(target)); }

void RemoveTemporariesOfThisProcess() noexcept {
  try {
    Temporaries::OfThisProcess().RemoveAll();
  } catch (const std::exception&) {
    // They are removed as abandoned later.
  }
}

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

void RequireNoInput(const NamedFile& output, const std::vector<NamedFile>& inputs) {
  for (const NamedFile& input : inputs) {
    std::error_code none;  // a missing file is not the same file
    if (!fs::equivalent(output.file, input.file, none)) continue;
    throw InputError(fmt::format("{} {} is the same file as {} {}; an input is not overwritten",
                                 output.name, output.file.string(), input.name,
                                 input.file.string()));
  }
}

std::string FaultOfFileName(std::string_view name, std::string_view extension) {
  if (name == "-") return "\"-\" is no name of a file; nothing is written to standard output";
  if (extension.empty() || HasExtension(name, extension)) return "";
  return fmt::format("\"{}\" must end in {}, which is what is written", name, extension);
}

std::string FaultOfFolderName(std::string_view name) {
  const bool file =
      std::any_of(kExtensionsOfFiles.begin(), kExtensionsOfFiles.end(),
                  [&](std::string_view extension) { return HasExtension(name, extension); });
  if (!file && name != "-") return "";
  return fmt::format("\"{}\" is no name of a folder, which files are written into", name);
}

}  // namespace alpenglow::lut
