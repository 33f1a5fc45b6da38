// SPDX-License-Identifier: MIT
// TOML files read strictly: what is not understood is refused, with file, line and key.
//
// Numbers that are NaN or infinite, values of another type, values out of range, duplicate and
// unknown keys are InputErrors of the form "scene.toml:7: camera.fov is 400; it must lie in ...".
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

/// The content of a text file. Throws InputError when it cannot be read or is over 16 MiB.
[[nodiscard]] std::string ReadTextFile(const std::filesystem::path& file);

/// The one of `known` with the smallest edit distance to `name`, when it is small enough to be a
/// slip of the hand; else nothing.
[[nodiscard]] std::optional<std::string> NearestName(std::string_view name,
                                                     const std::vector<std::string>& known);

/// A table of a TOML document. Copies share the document.
class TomlTable {
 public:
  /// The whole document; `origin` stands in messages where the file's name would.
  TomlTable(std::string_view text, const std::string& origin);

  /// Refuses every key but these, naming the nearest of them. To be called before values are read.
  void AllowOnly(const std::vector<std::string>& keys) const;

  [[nodiscard]] bool Has(const std::string& key) const;
  /// A number, integer or not, in [low, high].
  [[nodiscard]] std::optional<double> Number(const std::string& key, double low, double high) const;
  /// A list of numbers in [low, high]; a single number is a list of one.
  [[nodiscard]] std::optional<std::vector<double>> Numbers(const std::string& key, double low,
                                                           double high) const;
  [[nodiscard]] std::optional<std::string> Text(const std::string& key) const;
  [[nodiscard]] std::optional<bool> Truth(const std::string& key) const;
  [[nodiscard]] std::optional<TomlTable> Table(const std::string& key) const;
  /// The tables of [[key]]; none when the key is absent.
  [[nodiscard]] std::vector<TomlTable> Tables(const std::string& key) const;

  /// "camera.fov" of key fov in table camera.
  [[nodiscard]] std::string FullName(const std::string& key) const;
  /// Throws InputError "origin:line: <fault>", the line that of the key, or of the table when it
  /// has none of that name.
  [[noreturn]] void Fail(const std::string& key, const std::string& fault) const;

 private:
  struct Level;
  explicit TomlTable(std::shared_ptr<const Level> level);
  std::shared_ptr<const Level> level_;
};

}  // namespace alpenglow::atmosphere
