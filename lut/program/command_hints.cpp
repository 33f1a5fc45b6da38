// SPDX-License-Identifier: MIT
#include "lut/program/command_hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "atmosphere/text/toml_table.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

/// A single letter stands for the options that begin with it.
std::vector<std::string> OptionsLike(const std::string& name,
                                     const std::vector<std::string>& known) {
  if (name.size() != 1) {
    const std::optional<std::string> nearest = NearestName(name, known);
    return nearest ? std::vector<std::string>{*nearest} : std::vector<std::string>{};
  }
  std::vector<std::string> like;
  for (const std::string& one : known) {
    const bool is_new = std::find(like.begin(), like.end(), one) == like.end();
    if (one.starts_with(name) && is_new) like.push_back(one);
  }
  return like;
}

}  // namespace

std::string FaultOfCommand(const std::string& word, const std::vector<std::string>& commands) {
  std::error_code error;
  const bool is_known = std::find(commands.begin(), commands.end(), word) != commands.end();
  if (word.empty() || word.find_first_of("-./\\") != std::string::npos || is_known ||
      std::filesystem::exists(word, error)) {
    return "";
  }
  if (word == "help" || word == "version")
    return fmt::format("unknown command {0}; did you mean --{0}?", word);
  const std::optional<std::string> nearest = NearestName(word, commands);
  return nearest ? fmt::format("unknown command {}; did you mean {}?", word, *nearest) : "";
}

std::string FaultOfUnknownOption(const std::string& option, const std::vector<std::string>& known) {
  const std::string typed = option.substr(0, option.find('='));
  const std::string name = typed.substr(std::min(typed.find_first_not_of('-'), typed.size()));
  const std::vector<std::string> like = OptionsLike(name, known);
  if (like.empty()) return fmt::format("unknown option {}", typed);
  return fmt::format("unknown option {}; did you mean --{}?", typed, fmt::join(like, " or --"));
}

}  // namespace alpenglow::lut
