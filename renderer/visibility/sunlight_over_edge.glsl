// Fraction of sunlight that passes a straight edge across the sun's disk (sunlit_path.h).

// Integral over the circular segment of a disk with limb darkening w = 0.6, where x is the height
// of the disk's centre over the edge in radii:
//
//   ((1 - w) (pi - acos x + x sqrt(1 - x^2)) + w pi / 2 (x - x^3 / 3 + 2 / 3)) / (pi (1 - w / 3)).
SHARED Number SunlightOverEdge(Number height) {
  Number x = min(max(height, Number(-1.0)), Number(1.0));
  Number chord = sqrt((Number(1.0) - x) * (Number(1.0) + x));
  Number even = atan(chord, -x) + x * chord;
  Number darkened =
      Number(1.5707963267948966) * (x - x * x * x / Number(3.0) + Number(0.6666666666666667));
  Number passed = Number(0.4) * even + Number(0.6) * darkened;
  return min(max(passed / Number(2.513274122871834), Number(0.0)), Number(1.0));
}
