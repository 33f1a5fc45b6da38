// SPDX-License-Identifier: MIT
// The studies of the program `studies`. The file of the same name describes what a study measures
// and which arguments it takes; results are in README.md.
#pragma once

namespace alpenglow::tests {

// arguments[0] is the name of the study. A study throws InputError if arguments are missing.
void CausticError(int count, char** arguments);
void DayExposure(int count, char** arguments);
void EffectsError(int count, char** arguments);
void ExchangeError(int count, char** arguments);
void LayerError(int count, char** arguments);
void PathStudy(int count, char** arguments);
void RefractedTwilightError(int count, char** arguments);
void SkyTint(int count, char** arguments);
void StokesStudy(int count, char** arguments);
void TileMemory(int count, char** arguments);
void ViewerError(int count, char** arguments);
void VolumeError(int count, char** arguments);

// These need the viewer.
void ShadeError(int count, char** arguments);
void ViewerParity(int count, char** arguments);

}  // namespace alpenglow::tests
