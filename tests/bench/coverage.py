#!/usr/bin/env python3
"""Lists the functions of the libraries that the tests of the preset ci execute and those of sanitize do not.

Both presets are built with gcov's counters, in build/coverage-ci and build/coverage-sanitize, and run once,
which takes about an hour. A function is known by its file and line, so that all instances of a template count
as one. Threads may lose counts of each other, but not whether a function was executed.

Usage: python3 tests/bench/coverage.py [--filter REGEX]   (REGEX: the lines of CTest to run, as ctest -R)
"""
import argparse
import concurrent.futures
import gzip
import json
import os
import pathlib
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("atmosphere", "lut", "renderer", "viewer")


def build_and_run(preset, only):
    """Builds a preset with counters and runs its tests; returns the folder of the build."""
    build = TOP / "build" / f"coverage-{preset}"
    flags = "-D_GLIBCXX_ASSERTIONS --coverage"
    subprocess.run(["cmake", "--preset", preset, "-B", build, f"-DCMAKE_CXX_FLAGS={flags}",
                    "-DALPENGLOW_WARNINGS_AS_ERRORS=OFF"], cwd=TOP, check=True)
    subprocess.run(["cmake", "--build", build], check=True)
    for counts in build.rglob("*.gcda"):
        counts.unlink()
    # Software OpenGL without threads of its own, as the preset's tests have it (CMakePresets.json).
    environment = {**os.environ, "LP_NUM_THREADS": "0"} if preset == "sanitize" else os.environ
    environment = {"ASAN_OPTIONS": "detect_leaks=0", **environment}
    # Threads on two processors that count in the same place slow down each other, so every processor runs
    # lines of its own.
    processors = sorted(os.sched_getaffinity(0))
    runs = [subprocess.Popen(["taskset", "--cpu-list", str(processor), "ctest", "--test-dir", build,
                              "-LE", "bench", "-I", f"{first + 1},,{len(processors)}",
                              *(["-R", only] if only else [])], env=environment)
            for first, processor in enumerate(processors)]
    if any([run.wait() for run in runs]):
        sys.exit(f"tests of {preset} failed")
    return build


def functions_of(counts):
    """Yields (file, line, name, executions) of every function of the libraries that an object has."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["gcov", "--json-format", counts], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for result in pathlib.Path(folder).glob("*.gcov.json.gz"):
            for source in json.loads(gzip.decompress(result.read_bytes()))["files"]:
                path = pathlib.Path(source["file"])
                if not path.is_relative_to(TOP) or path.relative_to(TOP).parts[0] not in FOLDERS:
                    continue
                for function in source["functions"]:
                    yield (str(path.relative_to(TOP)), function["start_line"],
                           function["demangled_name"], function["execution_count"])


def executed_functions(build):
    """A dictionary from (file, line) to the name of every function that was executed."""
    executed = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for found in pool.map(lambda counts: list(functions_of(counts)), build.rglob("*.gcda")):
            executed.update({(file, line): name for file, line, name, count in found if count > 0})
    return executed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--filter", default="", help="lines of CTest to run, as ctest -R")
    only = parser.parse_args().filter
    optimised, sanitized = (executed_functions(build_and_run(preset, only))
                            for preset in ("ci", "sanitize"))
    missing = sorted(set(optimised) - set(sanitized))
    for file, line in missing:
        print(f"{file}:{line}: {optimised[file, line]}")
    print(f"{len(optimised)} functions are executed by ci, {len(sanitized)} by sanitize, "
          f"{len(missing)} by ci alone")
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main()
