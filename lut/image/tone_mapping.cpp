// SPDX-License-Identifier: MIT
#include "lut/image/tone_mapping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

constexpr EnumNames<AgxLook, 5> kLooks({{AgxLook::kPhoto, "photo"},
                                        {AgxLook::kNone, "none"},
                                        {AgxLook::kPunchy, "punchy"},
                                        {AgxLook::kMedium, "medium"},
                                        {AgxLook::kHigh, "high"}});

}  // namespace

AgxGrade GradeOf(AgxLook look) {
  switch (look) {
    case AgxLook::kPhoto:
      return {0.6, 1.8, true, 0.38, 1.0, 1.0, 0.35, true};
    case AgxLook::kNone:
      return {};
    case AgxLook::kPunchy:
      return {0.0, 1.0, false, 0.0, 1.3, 1.2, 0.0, false};
    case AgxLook::kMedium:
      return {0.0, 1.2, false, 0.0, 1.0, 1.0, 0.0, false};
    case AgxLook::kHigh:
      return {0.0, 1.4, false, 0.0, 1.0, 0.95, 0.0, false};
  }
  throw InternalError("unknown look");
}

AgxLook AgxLookFromName(const std::string& name) {
  return kLooks.Named(name, "look is \"{}\"; it must be one of {}");
}

std::string NameOf(AgxLook look) { return kLooks.Of(look); }

std::vector<std::string> AgxLookNames() { return kLooks.All(); }

}  // namespace alpenglow::lut
