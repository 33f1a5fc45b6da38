#!/usr/bin/env bash
# Twelve scenes that a look must suit, and a sheet of them.
#   twelve.sh SKYSERIES OUT [option ...]
# renders OUT/NAME.exr and .png with the options (--look, --exposure ...), develops anew what is there
# already, and writes OUT/sheet.png by ImageMagick.
set -euo pipefail
skyseries=$1 out=$2
shift 2
here=$(dirname "${BASH_SOURCE[0]}")
mkdir -p "$out"

scene() { # name, then what skyseries is told
  local name=$1
  shift
  "$skyseries" "${@}" "${common[@]}" --out "$out/$name.exr"
}
common=(--size "${SIZE:-480x270}" --png --aov scotopic --resume --quiet "$@")
winter=(--zone Europe/Zurich --date 2026-02-10)
sea="$out/sea.toml"
cat >"$sea" <<'END'
[place]
latitude = 38.0
longitude = -28.0
zone = "Atlantic/Azores"
[camera]
height_m = 40.0
heading = 200.0
pitch = -2.0
fov = 60.0
[terrain]
none = true
[ground]
cover = "water"
wind_m_per_s = 6.0
END

scene range --date 2026-06-21 --at noon
scene snow "${winter[@]}" --at 2026-02-10T11:00:00 --above-ground 60 --heading 300 --pitch -4
scene sea "$sea" --at 2026-06-21T11:00:00
scene sunset_towards "$here/range.toml" --at sunset-10m
scene sunset_away --date 2026-06-21 --at sunset-10m --heading 110 --pitch 2 --above-ground 400
scene twilight "$here/range.toml" --at civil-dusk-10m
scene blue_hour "$here/range.toml" --at civil-dusk+12m
scene airliner --date 2026-06-21 --at noon --height 12000 --pitch -6
scene orbit --date 2026-06-21 --at noon --height 400000 --pitch -22
scene fog "$here/valley_fog.toml"
scene runway "$here/runway.toml"
scene forest --date 2026-07-15 --at noon-3h --above-ground 150 --heading 20 --pitch -12
montage -label '%t' "$out"/{range,snow,sea,sunset_towards,sunset_away,twilight,blue_hour,airliner,orbit,fog,runway,forest}.png \
  -tile 4x3 -geometry +3+3 "$out/sheet.png"
