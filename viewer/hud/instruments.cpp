// SPDX-License-Identifier: MIT
#include "viewer/hud/instruments.h"

#include "viewer/hud/corner_texts.h"
#include "viewer/hud/pitch_ladder.h"
#include "viewer/hud/tapes.h"

namespace alpenglow {
namespace {

bool IsSmall(const Canvas& canvas, const HudFrame& frame) {
  return frame.width < canvas.Pixels(800.0) || frame.height < canvas.Pixels(540.0);
}

}  // namespace

void DrawInstruments(const Canvas& canvas, const HudFrame& frame, const HudModel& model) {
  DrawPitchLadder(canvas, frame, model.flight);
  if (IsSmall(canvas, frame)) {
    DrawHeadingNumber(canvas, frame, model);
    DrawSpeedAndHeightNumbers(canvas, frame, model);
    DrawCornerTexts(canvas, frame, ShortCornerTextsOf(model));
  } else {
    DrawBankScale(canvas, frame, model.flight);
    DrawHeadingTape(canvas, frame, model);
    DrawSpeedTape(canvas, frame, model);
    DrawHeightTape(canvas, frame, model);
    DrawCornerTexts(canvas, frame, CornerTextsOf(model));
  }
  DrawMessages(canvas, frame, model);
}

}  // namespace alpenglow
