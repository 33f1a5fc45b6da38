// SPDX-License-Identifier: MIT
#include "viewer/hud/instruments.h"

#include <cmath>

#include "viewer/hud/corner_texts.h"
#include "viewer/hud/pitch_ladder.h"
#include "viewer/hud/tapes.h"

namespace alpenglow::viewer {
namespace {

bool IsSmall(const Canvas& canvas, const HudFrame& frame) {
  return frame.width < canvas.Pixels(800.0) || frame.height < canvas.Pixels(540.0);
}

CornerTexts TextsFor(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  return IsSmall(canvas, frame) ? ShortCornerTextsOf(model) : CornerTextsOf(model);
}

}  // namespace

int ClockHeight(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  return static_cast<int>(std::ceil(BottomOfClock(canvas, frame, TextsFor(canvas, frame, model))));
}

void DrawInstruments(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  DrawPitchLadder(canvas, frame, model.flight);
  if (IsSmall(canvas, frame)) {
    DrawHeadingNumber(canvas, frame, model);
    DrawSpeedAndHeightNumbers(canvas, frame, model);
  } else {
    DrawBankScale(canvas, frame, model.flight);
    DrawHeadingTape(canvas, frame, model);
    DrawSpeedTape(canvas, frame, model);
    DrawHeightTape(canvas, frame, model);
  }
  DrawCornerTexts(canvas, frame, TextsFor(canvas, frame, model));
  DrawMessages(canvas, frame, model);
}

}  // namespace alpenglow::viewer
