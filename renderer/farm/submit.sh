#!/bin/bash
# A series on a Slurm farm, and what is made of its frames:
#
#   renderer/farm/submit.sh OUT [options of sbatch] -- skyseries SCENE.toml ... --out 'DIR/f.%04d.exr'
#
# asks the program how many frames there are, submits them as an array (frames.sbatch), and a job that
# waits for all of them and writes OUT/sheet.png, OUT/keogram.png, OUT/plot.svg, the manifests and,
# where the farm has ffmpeg, OUT/film.mp4. PER_TASK frames make a task (1): some seconds of each go
# into terrain and air. Prints the ids of the two jobs.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
usage() { sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
[[ $# -ge 1 ]] || usage
out=$1; shift
slurm=()
while [[ $# -gt 0 && $1 != -- ]]; do slurm+=("$1"); shift; done
[[ ${1:-} = -- && $# -ge 2 ]] || usage
shift

export FRAMES PER_TASK=${PER_TASK:-1}
list=$("$@" --list)  # ends with the program's status if it refuses
FRAMES=$(($(wc -l <<< "$list") - 1))
((FRAMES > 0)) || { echo "submit.sh: the series has no frames" >&2; exit 3; }
mkdir -p "$out"
array=$(sbatch --parsable --export=ALL --output="$out/frames-%A_%a.log" \
  --array="0-$(((FRAMES - 1) / PER_TASK))" "${slurm[@]}" "$here/frames.sbatch" "$@")
# If a frame failed for good there is nothing to wait for.
last=$(sbatch --parsable --export=ALL --output="$out/finish-%j.log" --kill-on-invalid-dep=yes \
  --dependency="afterok:${array%%;*}" "${slurm[@]}" "$here/finish.sbatch" "$out" "$@")
echo "frames ${array%%;*}, finish ${last%%;*}"
