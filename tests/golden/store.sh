#!/bin/sh
# Stores the golden pictures of pictures.csv, or those that are named, as the program renders them.
#   store.sh PROGRAM [NAME...]        with PROGRAM the path of skyseries
set -eu
program=$1
shift
folder=$(dirname "$0")
sed 1d "$folder/pictures.csv" | while IFS=, read -r name scene time; do
  case " $* " in *" $name "*) ;; *) [ $# -eq 0 ] || continue ;; esac
  "$program" "$folder/$scene" --quiet --at "$time" --size 48x27 --samples 16 \
    --out "$folder/$name.exr"
  rm -f "$folder/$name.manifest.csv" "$folder/$name.manifest.json"
  echo "$name: $(wc -c < "$folder/$name.exr") bytes"
done
