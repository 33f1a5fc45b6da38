// A plug-in of another program: a module that exports one function and nothing of the library.
#include <alpenglow/alpenglow.h>

extern "C" __attribute__((visibility("default"))) double ZenithLuminance() {
  using namespace alpenglow;
  const Sky sky(Atmosphere::Preset("earth"));
  const Spectrum zenith =
      sky.Radiance({.up_m = 2.0}, {.up = 1.0}, DirectionFromAngles(30.0, 180.0));
  return Luminance(sky.atmosphere().ColourOf(zenith));
}
