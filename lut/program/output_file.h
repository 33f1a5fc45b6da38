// SPDX-License-Identifier: MIT
// File descriptors, owned.
//
// Files that are written whole or not at all.
//
// Files that grow while work goes on, and get their names when it is done.
//
// Until then the lines stand in NAME.part, each in the system's hands as soon as it is appended: a
// process that is killed leaves all of them, a machine that loses its power those of the last Sync.
//
// Names of outputs that are refused before the work.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alpenglow::lut {

/// A descriptor that is closed whatever happens; a negative number is none.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  [[nodiscard]] bool valid() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

/// Writes a file whole or not at all: `write` gets the name of an empty temporary in the target's
/// folder (mode from the umask, a name that no other process uses), which is flushed to the disk
/// and renamed to `target` when `write` returns. Creates no folders; a symbolic link is followed; a
/// target that exists and is no regular file (a folder, a device) is refused.
///
/// On failure the temporary is removed. OutputError and filesystem_error from `write` become an
/// OutputError that names the target; other exceptions pass.
void WriteFileAtomically(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path&)>& write);

/// As above, with the whole content given.
void WriteTextAtomically(const std::filesystem::path& target, std::string_view text);

/// Throws the OutputError that writing there would end with (no such folder, no right, a folder of
/// that name): before the work, so that it is not lost.
void RequireWritable(const std::filesystem::path& target);

/// The name that content for `target` goes to: the end of a symbolic link. Throws OutputError for
/// what exists and is no regular file.
[[nodiscard]] std::filesystem::path FinalName(const std::filesystem::path& target);

/// Removes the temporaries in a folder whose writers were killed, and no others: of this machine,
/// by their names (a farm shares folders), and locked by nobody, as their writers keep them until
/// they are done. File systems without locks keep theirs. Returns how many were removed.
std::size_t RemoveAbandonedTemporaries(const std::filesystem::path& folder);

/// Appended to and finished by one thread; another one may Sync.
class GrowingFile {
 public:
  /// Begins TARGET.part. One that another process writes is an error; one whose writer was killed is
  /// kept under the next free of TARGET.1.part, TARGET.2.part, ... Throws OutputError.
  explicit GrowingFile(const std::filesystem::path& target);
  /// What is not finished stays in the .part; one without a line goes.
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// Appends text that ends in a line's end. Throws OutputError; then nothing of it is in the file.
  void Append(std::string_view lines);
  /// Brings what was appended to the disk; what fails is found again by Finish.
  void Sync() const noexcept;
  /// Brings everything to the disk and gives the file its name; without a line there is no file.
  /// Only once, and the last call. Throws OutputError; then the lines stay in the .part.
  void Finish();

  [[nodiscard]] const std::filesystem::path& part() const { return part_; }
  /// Where a .part went that was there before.
  [[nodiscard]] const std::optional<std::filesystem::path>& kept() const { return kept_; }

  /// TARGET.part
  [[nodiscard]] static std::filesystem::path PartOf(const std::filesystem::path& target);

 private:
  [[noreturn]] void Fail(const std::string& fault) const;
  void Open();
  [[nodiscard]] bool IsOurs() const;
  void KeepAside();

  std::filesystem::path target_, part_;
  std::optional<std::filesystem::path> kept_;
  Descriptor file_{-1};
  long long bytes_ = 0;  // of whole lines
};

/// A file and what the user calls it: "--cases", "terrain.colour".
struct NamedFile {
  std::string name;
  std::filesystem::path file;
};

/// Throws InputError when the output is one of the inputs, under whatever name: writing it would
/// destroy what it is made from.
void RequireNoInput(const NamedFile& output, const std::vector<NamedFile>& inputs);

/// What is wrong with the name of a file that is written with this extension (".exr"; empty: any),
/// for the command line; empty when nothing is. "-" is no file's name.
[[nodiscard]] std::string FaultOfFileName(std::string_view name, std::string_view extension);

/// The same for a folder of files: the name of a picture
/// or a table file is no folder's, "-" is no folder's.
[[nodiscard]] std::string FaultOfFolderName(std::string_view name);

}  // namespace alpenglow::lut
