// SPDX-License-Identifier: MIT
// "The sun" of all texts is a light of the sky, sun or moon. Programs with TWO_LIGHTS evaluate
// their functions for the first light, and then for the second one, with of_other set. It is set
// to constants only, so that compilers remove the branches. Every text that uses these macros is
// preceded by this one, which may therefore come several times.
#ifndef OF_LIGHT
#ifdef TWO_LIGHTS
bool of_other = false;
#define OF_LIGHT(first, second) (of_other ? second : first)
#define TEXEL_OF_LIGHT(first, second, at) (of_other ? textureLod(second, at, 0.0) : textureLod(first, at, 0.0))
#else
#define OF_LIGHT(first, second) first
#define TEXEL_OF_LIGHT(first, second, at) textureLod(first, at, 0.0)
#endif

// Returns whether the current light is known to send no beam to any ground in view, and its tables of
// the air to be those of a set sun (HasSetInView of air_tables.h). It is a constant, so that compilers
// remove what the beam would light.
bool HasSet() {
#ifdef OTHER_HAS_SET
  return OF_LIGHT(false, true);
#else
  return false;
#endif
}
#endif
