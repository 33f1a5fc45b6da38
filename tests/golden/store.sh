#!/bin/sh
# Stores the golden pictures of pictures.csv, or those that are named, as skyseries renders them, in half floats.
#   store.sh BUILD [NAME...]        with BUILD the folder of a preset, build/ci
set -eu
build=$1
shift
folder=$(dirname "$0")
cmake --build "$build" --target skyseries half_floats
rendered=$(mktemp -d)
trap 'rm -r "$rendered"' EXIT
sed 1d "$folder/pictures.csv" | while IFS=, read -r name scene time; do
  case " $* " in *" $name "*) ;; *) [ $# -eq 0 ] || continue ;; esac
  "$build/renderer/skyseries" "$folder/$scene" --quiet --at "$time" --size 160x90 --samples 4 \
    --out "$rendered/$name.exr"
  "$build/tests/half_floats" "$rendered/$name.exr" "$folder/$name.exr"
  echo "$name: $(wc -c < "$folder/$name.exr") bytes"
done
