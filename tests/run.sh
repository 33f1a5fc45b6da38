#!/usr/bin/env bash
# Installs packages, then builds and runs every test in the presets named as arguments
# (default: ci and sanitize; see CMakePresets.json).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash .ci/install-packages.sh
presets=("$@")
[ "${#presets[@]}" -gt 0 ] || presets=(ci sanitize)
# Where a library has been loaded late, LeakSanitizer of gcc 12 reads thread-local storage where there
# is none: what it intercepts is not what this glibc gives it (log_threads=1 shows "DTLS 21 at 0x2ac6").
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1:intercept_tls_get_addr=0}
export LSAN_OPTIONS=${LSAN_OPTIONS:-suppressions=$PWD/tests/leaks_of_drivers.txt:print_suppressions=0}
times=()
for preset in "${presets[@]}"; do
  echo "== $preset: build"
  start=$SECONDS
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset"
  built=$SECONDS
  echo "== $preset: test"
  ctest --preset "$preset" --parallel "$(nproc)"
  times+=("$preset: built in $((built - start)) s, tested in $((SECONDS - built)) s")
done
printf '%s\n' "${times[@]}"
