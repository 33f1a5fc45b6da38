#!/usr/bin/env bash
# From a fresh Debian 12 to pictures: packages, build, then the built-in mountain range from an hour
# before sunrise to an hour after sunset, its noon first. The pictures are in out/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

bash .ci/install-packages.sh
build=build/quickstart
mkdir -p out
day=("$build/renderer/skyseries" --out 'out/day.%04d.exr' --png --size 960x540
  --date 2026-03-21 --from sunrise-1h --to sunset+1h --every 40m)

echo "Building the renderer"
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DALPENGLOW_TESTS=OFF \
  -DCMAKE_UNITY_BUILD=ON >/dev/null  # halves the time of a first build
cmake --build "$build" --target skyseries
"${day[@]}" --quiet --frames 10
echo "The first picture: out/day.0010.png"

echo "Rendering the day, and building the other programs meanwhile (log: $build/build.log)"
cmake --build "$build" >"$build/build.log" 2>&1 &
rest=$!
"${day[@]}" --resume --contact-sheet out/day.png
wait "$rest" || { cat "$build/build.log"; exit 1; }
echo "Done: out/day.png shows the whole day, out/day.0000.png and on the single frames."
