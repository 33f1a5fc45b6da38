// SPDX-License-Identifier: MIT
#include "lut/image/tone_mapping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "atmosphere/base/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

struct NamedLook {
  AgxLook look;
  const char* name;
  AgxGrade grade;
};

constexpr std::array<NamedLook, 5> kLooks{{
    {AgxLook::kPhoto, "photo", {0.6, 1.8, true, 0.38, 1.0, 1.0, 0.35, true}},
    {AgxLook::kNone, "none", {}},
    {AgxLook::kPunchy, "punchy", {0.0, 1.0, false, 0.0, 1.3, 1.2, 0.0, false}},
    {AgxLook::kMedium, "medium", {0.0, 1.2, false, 0.0, 1.0, 1.0, 0.0, false}},
    {AgxLook::kHigh, "high", {0.0, 1.4, false, 0.0, 1.0, 0.95, 0.0, false}},
}};

const NamedLook& Entry(AgxLook look) {
  for (const NamedLook& entry : kLooks) {
    if (entry.look == look) return entry;
  }
  throw InternalError("unknown look");
}

}  // namespace

AgxGrade GradeOf(AgxLook look) { return Entry(look).grade; }

AgxLook AgxLookFromName(const std::string& name) {
  for (const NamedLook& entry : kLooks) {
    if (name == entry.name) return entry.look;
  }
  throw InputError(
      fmt::format("look is \"{}\"; it must be one of {}", name, fmt::join(AgxLookNames(), ", ")));
}

std::string NameOf(AgxLook look) { return Entry(look).name; }

std::vector<std::string> AgxLookNames() {
  std::vector<std::string> names;
  for (const NamedLook& entry : kLooks) names.emplace_back(entry.name);
  return names;
}

}  // namespace alpenglow::lut
