#!/usr/bin/env bash
# Installs packages, then builds and runs every test in the presets named as arguments
# (default: ci, sanitize and scalar; see CMakePresets.json).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash .ci/install-packages.sh
presets=("$@")
[ "${#presets[@]}" -gt 0 ] || presets=(ci sanitize scalar)
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1}
export LSAN_OPTIONS=${LSAN_OPTIONS:-suppressions=$PWD/tests/leaks_of_drivers.txt:print_suppressions=0}

# LeakSanitizer of gcc 12 now and then crashes itself at the end of a test that has passed, while it
# reads threads of an OpenGL driver that are ending. Where that is all that failed, what it stopped
# runs once more.
run_tests() {
  ctest --preset "$1" --parallel "$(nproc)" && return
  local logs=build/$1/Testing/Temporary
  local failed crashed
  failed=$(wc -l <"$logs/LastTestsFailed.log")
  crashed=$(grep -c "LeakSanitizer has encountered a fatal error" "$logs/LastTest.log") || return 1
  [ "$failed" -eq "$crashed" ] && ctest --preset "$1" --rerun-failed
}

times=()
for preset in "${presets[@]}"; do
  echo "== $preset: build"
  start=$SECONDS
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset"
  built=$SECONDS
  echo "== $preset: test"
  run_tests "$preset"
  times+=("$preset: built in $((built - start)) s, tested in $((SECONDS - built)) s")
done
printf '%s\n' "${times[@]}"
