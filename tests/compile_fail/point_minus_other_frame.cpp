// SPDX-License-Identifier: MIT
// Must not compile: points of two frames have no difference. With ALPENGLOW_CONTROL the frames are
// the same and it must compile, which proves that nothing else is wrong with this file.
#include "atmosphere/time_place/geodesy.h"

#ifdef ALPENGLOW_CONTROL
using OtherFrame = alpenglow::atmosphere::Ecef;
#else
using OtherFrame = alpenglow::atmosphere::Enu;
#endif

auto Difference(const alpenglow::atmosphere::Point<alpenglow::atmosphere::Ecef>& to,
                const alpenglow::atmosphere::Point<OtherFrame>& from) {
  return to - from;
}
