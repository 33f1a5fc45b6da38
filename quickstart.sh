#!/usr/bin/env bash
# From a fresh Debian 12 to pictures: packages, build, then the built-in mountain range under clouds of
# fair weather, from an hour before sunrise to sunset, its noon first. The pictures are in out/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

bash .ci/install-packages.sh
build=build/quickstart
mkdir -p out
day=("$build/renderer/skyseries" --out 'out/day.%04d.exr' --png --size 640x360
  --clouds fair --date 2026-03-21 --from sunrise-1h --to sunset+1h --every 80m)

echo "Building the renderer"
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DALPENGLOW_TESTS=OFF \
  -DCMAKE_UNITY_BUILD=ON >/dev/null  # halves the time of a first build
cmake --build "$build" --target skyseries
"${day[@]}" --quiet --frames 5
echo "The first picture: out/day.0005.png"

echo "Rendering the day"
"${day[@]}" --resume --contact-sheet out/day.png
echo "The whole day: out/day.png, out/day.0000.png and on the single frames"

echo "Building the other programs"
cmake --build "$build"
echo "Done: the programs are $build/lut/skylut, $build/renderer/skyseries and $build/viewer/skyview."
