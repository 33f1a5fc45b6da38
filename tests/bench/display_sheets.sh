#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sheets of pictures to be looked at, of the display by day, at dusk and by night:
#
#   day_auto.png, day_eye.png, day_incident.png   24 hours from noon, a column every 10 minutes
#   scenes.png, nights.png                        twelve scenes, six nights, as `skyseries` develops them
#   dusk.png                                      a flight through dusk in eight moments: the window of
#                                                 `skyview` under Xvfb, its file of that moment, and eight times
#                                                 their difference
#
#   tests/bench/display_sheets.sh OUT [BUILD]     BUILD: build/release
#
# Needs ImageMagick and Xvfb. Prints the mean differences of dusk, as shares of the range of codes.
# To compare two states of the program, make the sheets of both.
set -euo pipefail

out=${1:?"usage: $0 OUT [BUILD]"}
build=${2:-build/release}
skyseries=$(realpath "$build/renderer/skyseries")
skyview=$(realpath "$build/viewer/skyview")
mkdir -p "$out"
cd "$out"
display=:97

keogram() {  # exposure
  "$skyseries" --date 2026-06-21 --from noon --to noon+24h --every 10m --size 64x72 --samples 4 --png \
    --exposure "$1" --out "frames_$1/f.%04d.exr" --keogram "day_$1.png" --quiet
}

picture() {  # name, options
  local name=$1
  shift
  "$skyseries" --size 480x270 --samples 16 --png --quiet --out "$name.exr" "$@"
}

# Lines: name, options.
pictures_of() {
  while read -r name options; do
    # shellcheck disable=SC2086  # options are words
    [ -z "$name" ] || picture "$name" $options
  done
}

scenes() {
  pictures_of <<'LINES'
scene_01_noon --at 2026-06-21T11:00:00Z
scene_02_winter_noon --at 2026-12-21T11:20:00Z
scene_03_morning --at 2026-06-21T06:00:00Z --heading 90
scene_04_before_sunset --at sunset-45m --heading 290
scene_05_sunset --at sunset --heading 300
scene_06_after_sunset --at sunset+15m --heading 300
scene_07_blue_hour --at civil-dusk --heading 300
scene_08_haze --at sunset-90m --heading 270 --atmosphere hazy
scene_09_incident --at sunset-20m --heading 300 --exposure incident
scene_10_eye --at civil-dusk --heading 300 --exposure eye
scene_11_aeroplane --at 2026-06-21T08:00:00Z --height 10000 --heading 160 --pitch -8
scene_12_orbit --at 2026-06-21T08:00:00Z --height 400000 --heading 160 --pitch -20
LINES
}

nights() {
  pictures_of <<'LINES'
night_1_orion --at 2026-01-15T22:00:00Z --heading 180 --pitch 25 --bortle 2
night_2_half_moon --at 2026-06-21T21:00:00Z
night_3_full_moon --at 2026-01-03T23:00:00Z
night_4_milky_way --at 2026-07-14T23:30:00Z --heading 190 --pitch 20 --bortle 1
night_5_town --at 2026-12-09T21:00:00Z --heading 200 --bortle 7
night_6_eclipse --at 2026-08-12T18:28:30Z --latitude 42.3439 --longitude -3.6969 --height 4000 --heading 284 --pitch 4
LINES
}

# Window and file of the same moment, without instruments, at one exposure.
dusk() {
  local moment n=0
  Xvfb "$display" -ac -screen 0 640x360x24 >/dev/null 2>&1 &
  server=$!
  trap 'kill "$server"' EXIT
  for moment in 19:10 19:20 19:30 19:40 19:50 20:00 20:20 20:50; do  # sunset is at 19:22
    n=$((n + 1))
    "$skyview" --time "2026-06-21T$moment:00Z" --headless --hud off --size 640x360 --quiet \
      --screenshot "dusk_$n.file.png"
    DISPLAY=$display "$skyview" --time "$(date -u -d "2026-06-21T$moment:00Z - 40 seconds" +%FT%TZ)" --hud off \
      --size 640x360 --vsync off --quiet &
    local window=$!
    sleep 45
    DISPLAY=$display import -window root "dusk_$n.window.png"
    kill "$window"
    wait "$window" || true
    convert "dusk_$n.window.png" "dusk_$n.file.png" -compose difference -composite -evaluate multiply 8 \
      "dusk_$n.off.png"
    printf '%s: mean %s of 1\n' "$moment" \
      "$(compare -metric MAE "dusk_$n.window.png" "dusk_$n.file.png" null: 2>&1 | sed 's/.*(\(.*\))/\1/' || true)"
  done
}

scenes
nights
for exposure in auto eye incident; do keogram "$exposure"; done
dusk
montage scene_*.png -tile 3x -geometry 480x270+2+2 scenes.png
montage night_*.png -tile 3x -geometry 480x270+2+2 nights.png
montage dusk_*.window.png dusk_*.file.png dusk_*.off.png -tile 8x -geometry 320x180+2+2 dusk.png
