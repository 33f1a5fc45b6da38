// SPDX-License-Identifier: MIT
// Files that grow while work goes on, and get their names when it is done.
//
// Until then the lines stand in NAME.part, each in the system's hands as soon as it is appended: a
// process that is killed leaves all of them, a machine that loses its power those of the last Sync.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lut/program/descriptor.h"

namespace alpenglow::lut {

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

}  // namespace alpenglow::lut
