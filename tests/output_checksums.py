#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checksums of what the three programs write, to show that a change of the code changes no output.

    python3 tests/output_checksums.py write build/ci before.json     # before the change
    python3 tests/output_checksums.py write build/ci after.json      # after it
    python3 tests/output_checksums.py compare before.json after.json

The outputs are a day of pictures, the golden scenes, a series with lamps and fog, a night, tables in
every layout, panoramas, evaluated cases and screenshots of the viewer. A checksum covers the pixels and
the header of a picture and the text of other files. It leaves out what differs between two runs of one
program: the version of the program, and measured times. "compare" prints every file whose checksum
differs and exits with 1 if there is one.
"""
import argparse
import hashlib
import itertools
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time

TREE = pathlib.Path(__file__).resolve().parent.parent
GOLDEN = TREE / "tests" / "golden"
VERSION = re.compile(rb"alpenglow \d+\.\d+\.\d+ \([^)]*\)")
FINGERPRINT = b"fingerprint"  # of a frame: it contains the version of the program
# Columns of a manifest, and keys of its JSON, that hold measured times.
MEASURED = re.compile(r"(^|_)(seconds|render_s|prepare_s|elapsed_s)$")


def day_jobs():
    frames = ["--out", "day.%04d.exr", "--png", "--size", "640x360", "--contact-sheet", "day.png"]
    yield "day", "skyseries", [*frames, "--date", "2026-03-21", "--from", "sunrise-1h", "--to", "sunset+1h",
                               "--every", "40m"]


def scene_jobs():
    for line in (GOLDEN / "pictures.csv").read_text(encoding="utf-8").splitlines()[1:]:
        name, scene, instant = line.split(",")
        yield f"golden_{name}", "skyseries", [str(GOLDEN / scene), "--at", instant, "--size", "160x90",
                                              "--png", "--out", f"{name}.exr"]
    yield "lamps_and_fog", "skyseries", [str(GOLDEN / "runway.toml"), "--from", "2026-01-15T16:30:00",
                                         "--to", "2026-01-15T19:00:00", "--count", "30", "--size", "160x90",
                                         "--png", "--out", "runway.%04d.exr"]
    yield "moon_and_stars", "skyseries", ["--date", "2026-12-21", "--at", "2026-12-21T23:30:00Z", "--heading",
                                          "120", "--pitch", "25", "--fov", "80", "--size", "320x180", "--png",
                                          "--exposure", "eye", "--out", "night.exr"]


def table_jobs():
    for layout in ("native", "bruneton", "takram"):
        # The tables of Bruneton and takram have no phase functions but the lobe of one preset.
        air = [] if layout == "native" else ["--atmosphere", "bruneton2017"]
        yield f"build_{layout}", "skylut", ["build", "--layout", layout, *air, "--out", "tables"]
    for elevation in (60, 10, 0, -6):
        yield f"sky_{elevation}", "skylut", ["sky", "--sun-elevation", str(elevation), "--size", "512x256",
                                             "--out", "sky.exr", "--png", "sky.png"]


def write_cases(file):
    """Every quantity from two altitudes, up and down, from day to twilight."""
    quantities = ("transmittance", "optical_depth", "single", "inscatter_single", "total", "irradiance_sun",
                  "irradiance_sky", "stokes_q", "stokes_u")
    cases = itertools.product(quantities, (2, 9000), (20, 89, 100), (0, 110), (15, 85, 95), ("", 30000))
    lines = ["id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,distance_m"]
    lines += [",".join(map(str, (i, *case))) for i, case in enumerate(cases)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def evaluation_jobs():
    for method in ("integral", "table"):
        for air in ("earth", "hazy", "clear-mountain"):
            tables = ["--lut", "../build_native/tables"] if method == "table" else ["--atmosphere", air]
            if method == "integral" or air == "earth":
                yield f"eval_{method}_{air}", "skylut", [
                    "eval", "--method", method, *tables, "--cases", "../cases.csv", "--out", "results.csv"]


def viewer_jobs():
    views = {
        "noon": ["--time", "noon"],
        "sunset": ["--time", "sunset-20m", "--heading", "250"],
        "dusk": ["--time", "sunset+30m", "--heading", "250"],
        "night": ["--time", "2026-12-21T23:30:00Z", "--exposure", "eye"],
        "10_km": ["--time", "noon", "--altitude", "10000", "--pitch", "-8"],
        "400_km": ["--time", "noon", "--altitude", "400000", "--pitch", "-60"],
        "hud": ["--time", "sunrise+15m", "--hud", "on"],
        "runway": [str(GOLDEN / "runway.toml")],
        "valley_fog": [str(GOLDEN / "valley_fog.toml")],
        "moon_fog": [str(GOLDEN / "moon_fog.toml")],
    }
    for name, options in views.items():
        yield f"view_{name}", "skyview", [*options, "--headless", "--quality", "high", "--size", "640x360",
                                          "--screenshot", f"{name}.png"]


def jobs():
    for group in (table_jobs, evaluation_jobs, scene_jobs, viewer_jobs, day_jobs):
        yield from group()


def exr_header(data):
    """The attributes of the header by name, and where the header ends."""
    attributes, at = {}, 8
    while data[at]:
        name_end = data.index(0, at)
        type_end = data.index(0, name_end + 1)
        size = struct.unpack_from("<i", data, type_end + 1)[0]
        attributes[data[at:name_end]] = data[type_end + 5:type_end + 5 + size]
        at = type_end + 5 + size
    return attributes, at + 1


def digest_of_exr(data):
    """The table of offsets is left out: it moves with the length of the header."""
    attributes, end = exr_header(data)
    pixels_at = struct.unpack_from("<Q", data, end)[0]
    digest = hashlib.sha256()
    for name, value in sorted(attributes.items()):
        if FINGERPRINT not in name:
            digest.update(name + b"\0" + VERSION.sub(b"", value) + b"\0")
    digest.update(data[pixels_at:])
    return digest.hexdigest()


def digest_of_png(data):
    digest, at = hashlib.sha256(), 8
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        chunk = data[at + 8:at + 8 + size]
        if FINGERPRINT not in chunk.partition(b"\0")[0]:
            digest.update(kind + VERSION.sub(b"", chunk))
        at += 12 + size
    return digest.hexdigest()


def without_measured(value):
    if isinstance(value, dict):
        return {key: without_measured(inner) for key, inner in value.items() if not MEASURED.search(key)}
    return [without_measured(inner) for inner in value] if isinstance(value, list) else value


def csv_without_measured(text):
    lines = [line.split(",") for line in text.splitlines()]
    names = next((line for line in lines if not line[0].startswith("#")), [])
    measured = {i for i, name in enumerate(names) if MEASURED.search(name)}
    return "\n".join(",".join(cell for i, cell in enumerate(line) if i not in measured or len(line) != len(names))
                     for line in lines)


def digest_of_text(name, data):
    data = VERSION.sub(b"", data)
    if name.endswith(".json"):
        data = json.dumps(without_measured(json.loads(data)), sort_keys=True).encode()
    if name.endswith(".csv"):
        data = csv_without_measured(data.decode()).encode()
    return hashlib.sha256(data).hexdigest()


def digest_of(file):
    data = file.read_bytes()
    if file.suffix == ".exr":
        return digest_of_exr(data)
    if file.suffix == ".png":
        return digest_of_png(data)
    return digest_of_text(file.name, data)


def run_job(build, keep, job):
    name, program, arguments = job
    folder = keep / name
    folder.mkdir()
    path = next(build.glob(f"*/{program}")).resolve()
    result = subprocess.run([path, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise RuntimeError(f"{name}: {program} {' '.join(arguments)}: exit status {result.returncode}\n"
                           f"{result.stderr}")
    return {f"{name}/{file.relative_to(folder)}": digest_of(file)
            for file in sorted(folder.rglob("*")) if file.is_file()}


def write(build, target, only, keep):
    checksums = {}
    write_cases(keep / "cases.csv")
    for job in jobs():
        if only and not any(part in job[0] for part in only):
            continue
        start = time.monotonic()
        checksums.update(run_job(build, keep, job))
        print(f"{job[0]}: {time.monotonic() - start:.1f} s", flush=True)
    target.write_text(json.dumps(checksums, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    print(f"{len(checksums)} files")


def compare(before, after):
    old, new = (json.loads(file.read_text(encoding="utf-8")) for file in (before, after))
    different = sorted(name for name in old.keys() | new.keys() if old.get(name) != new.get(name))
    for name in different:
        print(f"{name}: {'missing' if name not in new else 'new' if name not in old else 'differs'}")
    print(f"{len(old.keys() & new.keys()) - sum(name in old and name in new for name in different)} of "
          f"{len(old)} files are equal")
    return 1 if different or not old else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    writing = commands.add_parser("write", help="run the programs and write the checksums")
    writing.add_argument("build", type=pathlib.Path, help="build folder with the three programs")
    writing.add_argument("checksums", type=pathlib.Path, help="JSON file")
    writing.add_argument("--only", nargs="+", help="run only the jobs whose names contain one of these")
    writing.add_argument("--keep", type=pathlib.Path, help="new folder for the outputs, to look at them")
    comparing = commands.add_parser("compare", help="compare two files of checksums")
    comparing.add_argument("before", type=pathlib.Path)
    comparing.add_argument("after", type=pathlib.Path)
    options = parser.parse_args()
    if options.command == "compare":
        return compare(options.before, options.after)
    if options.keep:
        options.keep.mkdir(parents=True)
        write(options.build, options.checksums, options.only, options.keep.resolve())
        return 0
    with tempfile.TemporaryDirectory() as folder:
        write(options.build, options.checksums, options.only, pathlib.Path(folder))
    return 0


if __name__ == "__main__":
    sys.exit(main())
