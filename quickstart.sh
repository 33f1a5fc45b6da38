#!/usr/bin/env bash
# From a fresh Debian or Ubuntu to pictures: packages, build, then the built-in mountain range from an hour
# before sunrise to an hour after sunset. The pictures are in out/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

bash .ci/install-packages.sh
echo "Building"
cmake -G Ninja -S . -B build/quickstart -DCMAKE_BUILD_TYPE=Release -DALPENGLOW_TESTS=OFF >/dev/null
cmake --build build/quickstart
mkdir -p out
echo "Rendering"
build/quickstart/renderer/skyseries --out 'out/day.%04d.exr' --png --size 960x540 \
  --date 2026-03-21 --from sunrise-1h --to sunset+1h --every 40m --contact-sheet out/day.png
echo "Done: out/day.png shows the whole day, out/day.0000.png and on the single frames."
