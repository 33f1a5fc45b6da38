#!/usr/bin/env bash
# Installs packages, then builds and runs every test in the presets named as arguments (default: ci; see
# CMakePresets.json). Fails when a test fails, and when one is skipped for a reason that
# tests/allowed_skips.txt does not list.
#
# SHAKE=N runs the tests of each preset N times more, in random order, with memory that is filled with
# another byte each time before it is used (MALLOC_PERTURB_): what depends on either is a fault.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash .ci/install-packages.sh
presets=("$@")
[ "${#presets[@]}" -gt 0 ] || presets=(ci)
# Where a library has been loaded late, LeakSanitizer of gcc 12 reads thread-local storage where there
# is none: what it intercepts is not what this glibc gives it (log_threads=1 shows "DTLS 21 at 0x2ac6").
# Five frames of the place of an allocation are enough to find it, and recording more costs a seventh of
# the time of the tests. 16 MB of freed memory are kept back from use, not 256: new pages for all that
# takes its place cost an eighth of the time of lut_command_tests.
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1:intercept_tls_get_addr=0:malloc_context_size=5:quarantine_size_mb=16}
export LSAN_OPTIONS=${LSAN_OPTIONS:-suppressions=$PWD/tests/leaks_of_drivers.txt:print_suppressions=0}

# run_tests <preset> [further options of ctest]
run_tests() {
  local lines=$PWD/build/$1/tests.xml results=$PWD/build/$1/tests/results
  rm -rf "$results"
  ctest --preset "$1" --parallel "$(nproc)" --output-junit "$lines" "${@:2}"
  python3 tests/check_skips.py "$lines" "$results"
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
  for ((round = 1; round <= ${SHAKE:-0}; ++round)); do
    fill=$((255 - 37 * (round - 1) % 255))
    echo "== $preset: test in random order, memory filled with $fill"
    MALLOC_PERTURB_=$fill GTEST_SHUFFLE=1 run_tests "$preset" --schedule-random
  done
done
printf '%s\n' "${times[@]}"
