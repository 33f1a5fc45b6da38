// SPDX-License-Identifier: MIT
// An output file that grows during a run.
//
// It gets its final name when the run is complete. Until then its lines are in
// NAME.part, and each is passed to the operating system as soon as it is appended: if the process
// is killed all lines remain, after a power failure those up to the last Sync.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lut/cli/output_file.h"

namespace alpenglow::lut {

/// A file to which lines are appended. One thread appends and finishes; another may call Sync.
class GrowingFile {
 public:
  /// Creates TARGET.part. If another process is writing it, this is an error; if its writer was
  /// killed, it is renamed to the first free name of TARGET.1.part, TARGET.2.part, ... Throws
  /// OutputError.
  explicit GrowingFile(const std::filesystem::path& target);
  /// Keeps the .part of an unfinished file, and removes it if it has no lines.
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// Appends text that ends with a line end. Throws OutputError; then none of the text is in the
  /// file.
  void Append(std::string_view lines);
  /// Flushes the appended text to the disk; a failure is detected again by Finish.
  void Sync() const noexcept;
  /// Flushes everything to the disk and gives the file its name; a file without lines is not
  /// created. This must be the last call, and only be called once. Throws OutputError; then the
  /// lines remain in the .part.
  void Finish();

  [[nodiscard]] const std::filesystem::path& part() const { return part_; }
  /// Returns the new name of a .part that already existed.
  [[nodiscard]] const std::optional<std::filesystem::path>& kept() const { return kept_; }

  /// Returns TARGET.part.
  [[nodiscard]] static std::filesystem::path PartOf(const std::filesystem::path& target);

 private:
  [[noreturn]] void Fail(const std::string& fault) const;
  void Open();
  [[nodiscard]] bool IsOurs() const;
  void KeepAside();

  std::filesystem::path target_, part_;
  std::optional<std::filesystem::path> kept_;
  Descriptor file_{-1};
  long long bytes_ = 0;  // length of the complete lines
};

}  // namespace alpenglow::lut
