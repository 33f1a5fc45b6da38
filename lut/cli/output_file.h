// SPDX-License-Identifier: MIT
// Output files: owned descriptors, files that are written atomically, and checks of output names
// before a run.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alpenglow::lut {

/// A file descriptor that is always closed by the destructor; a negative number means none.
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

/// Writes a file atomically: `write` receives the name of an empty temporary in the target's folder
/// (mode from the umask, a name that no other process uses). When `write` returns, the temporary is
/// flushed to the disk and renamed to `target`. Folders are not created; a symbolic link is
/// followed; a target that exists and is not a regular file (a folder, a device) is rejected.
///
/// On failure the temporary is removed. OutputError and filesystem_error from `write` become an
/// OutputError that names the target; other exceptions are passed on.
void WriteFileAtomically(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path&)>& write);

/// Writes the given text to a file atomically.
void WriteTextAtomically(const std::filesystem::path& target, std::string_view text);

/// Creates a folder and the folders above it; does nothing for an empty name. Throws OutputError
/// naming the folder if it cannot be created.
void MakeFolder(const std::filesystem::path& folder);

/// Throws the OutputError with which writing to the target would fail (missing folder, missing
/// permission, a folder with this name): to be called before the work, so that it is not lost.
void RequireWritable(const std::filesystem::path& target);

/// Returns the path to which content for `target` is written: the end of a symbolic link. Throws
/// OutputError if it exists and is not a regular file.
[[nodiscard]] std::filesystem::path FinalName(const std::filesystem::path& target);

/// Removes the temporaries in a folder whose writers were killed, and no other files. A temporary
/// is abandoned if its name is from this machine (a render farm shares folders) and no process has
/// locked it; writers keep their lock until they are done. On file systems without locks nothing is
/// removed. Returns the number of removed files.
std::size_t RemoveAbandonedTemporaries(const std::filesystem::path& folder);

/// Removes the temporaries that this process is writing, before it ends without unwinding.
void RemoveTemporariesOfThisProcess() noexcept;

/// A file and its name in the user's input: "--cases", "terrain.colour".
struct NamedFile {
  std::string name;
  std::filesystem::path file;
};

/// Throws InputError if the output is one of the inputs, under any name: writing it would destroy
/// the input.
void RequireNoInput(const NamedFile& output, const std::vector<NamedFile>& inputs);

/// Describes the fault of the name of a file that is written with this extension
/// (".exr"; empty: any), for the command line; empty if there is none. "-" is not a valid file
/// name.
[[nodiscard]] std::string FaultOfFileName(std::string_view name, std::string_view extension);

/// Describes the fault of the name of a folder; names with the extension of a picture or a table
/// file, and "-", are not valid.
[[nodiscard]] std::string FaultOfFolderName(std::string_view name);

}  // namespace alpenglow::lut
