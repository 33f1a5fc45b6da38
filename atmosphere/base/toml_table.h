// SPDX-License-Identifier: MIT
// Tables of TOML files, read strictly: unknown content is refused, with file, line and key.
//
// Numbers that are NaN or infinite, values of another type, values out of range, duplicate and
// unknown keys are InputErrors of the form "scene.toml:7: camera.fov is 400; it must lie in ...".
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

/// A column of a list of lists of numbers: its name in messages and the range of its numbers.
struct TomlColumn {
  std::string name;
  double low, high;
};

/// A table of a TOML document. Copies share the document.
class TomlTable {
 public:
  /// Reads the whole document; messages contain `origin` in place of the file name.
  TomlTable(std::string_view text, const std::string& origin);

  /// Throws for every key except these, naming the nearest of them. Must be called before values
  /// are read.
  void AllowOnly(const std::vector<std::string>& keys) const;

  [[nodiscard]] bool Has(const std::string& key) const;
  /// Returns a number, integer or not, in [low, high].
  [[nodiscard]] std::optional<double> Number(const std::string& key, double low, double high) const;
  /// Returns a list of numbers in [low, high]; a single number is a list of one.
  [[nodiscard]] std::optional<std::vector<double>> Numbers(const std::string& key, double low,
                                                           double high) const;
  /// Returns a list of lists of numbers, one for each column; columns from `required` on may be left
  /// out at the end of each list.
  [[nodiscard]] std::optional<std::vector<std::vector<double>>> Rows(
      const std::string& key, const std::vector<TomlColumn>& columns, std::size_t required) const;
  [[nodiscard]] std::optional<std::string> Text(const std::string& key) const;
  [[nodiscard]] std::optional<bool> Truth(const std::string& key) const;
  [[nodiscard]] std::optional<TomlTable> Table(const std::string& key) const;
  /// Returns the tables of [[key]]; empty if the key is absent.
  [[nodiscard]] std::vector<TomlTable> Tables(const std::string& key) const;

  /// Returns "camera.fov" for key fov in table camera.
  [[nodiscard]] std::string FullName(const std::string& key) const;
  /// Throws InputError "origin:line: <fault>" with the line of the key, or of the table if it has
  /// no such key.
  [[noreturn]] void Fail(const std::string& key, const std::string& fault) const;
  /// Throws InputError with the line of a row of Rows(), counted from 0.
  [[noreturn]] void FailInRow(const std::string& key, std::size_t row,
                              const std::string& fault) const;

 private:
  struct Level;
  explicit TomlTable(std::shared_ptr<const Level> level);
  std::shared_ptr<const Level> level_;
};

}  // namespace alpenglow::atmosphere
