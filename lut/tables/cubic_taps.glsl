// Catmull-Rom weights of the four neighbours of a position, from the node before the cell on; t in
// [0, 1] is the fraction of the cell.

SHARED Number CubicWeight0(Number t) {
  return Number(0.5) * t * (t * (Number(2.0) - t) - Number(1.0));
}

SHARED Number CubicWeight1(Number t) {
  return Number(0.5) * (Number(2.0) + t * t * (Number(3.0) * t - Number(5.0)));
}

SHARED Number CubicWeight2(Number t) {
  return Number(0.5) * t * (Number(1.0) + t * (Number(4.0) - Number(3.0) * t));
}

SHARED Number CubicWeight3(Number t) { return Number(0.5) * t * t * (t - Number(1.0)); }

// Returns the value of a node beyond the end of the grid from the last node and the two before it,
// by the parabola through these three.
SHARED Number BeyondEnd(Number last, Number before, Number second_before) {
  return Number(3.0) * (last - before) + second_before;
}
