#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Flies skyview as a user would, on a display of its own, and keeps what is seen.

    tests/golden/fly.py build/ci/viewer/skyview OUT [--dem N35E138.hgt] [--only keys,hud,...]

Run by hand; needs Xvfb, xdotool and ImageMagick, and ffmpeg for the film. Writes a picture of each
feature into OUT, prints what was checked, and ends with status 1 where something was not as it
should be. The flight of ten minutes (--only dusk) samples memory (/proc/PID/status) each second and
prints the ratio of the end's to the first minute's, and the worst frame over the median.
"""

import argparse
import contextlib
import os
import pathlib
import re
import signal
import statistics
import subprocess
import sys
import time

FAULTS = []


def check(holds, claim):
    print(("  ok     " if holds else "  FAULT  ") + claim, flush=True)
    if not holds:
        FAULTS.append(claim)


class Display:
    """An X server without a screen."""

    def __init__(self, size):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{size}x24", "-nolisten", "tcp", "-noreset"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as number:
            self.name = ":" + number.readline().strip()

    def close(self):
        self.server.terminate()
        self.server.wait()


class Flight:
    """A skyview in a window; ended with the object."""

    def __init__(self, options, display, arguments, size=None):
        # ImageMagick's threads spin: beside two busy cores a picture would take minutes.
        self.environment = dict(os.environ, DISPLAY=display.name, OMP_NUM_THREADS="1")
        self.folder = options.out
        self.log = open(options.out / "skyview.log", "ab")
        self.process = subprocess.Popen(
            [options.skyview, "--size", size or options.size, *map(str, arguments)], env=self.environment,
            cwd=options.out, stdout=subprocess.PIPE, stderr=self.log)
        self.began = time.monotonic()
        self.window = self.find_window()

    def find_window(self):
        """The window that lasts: the library that opens it makes another first and takes it away."""
        before = None
        while self.process.poll() is None and time.monotonic() < self.began + 60:
            found = self.run("xdotool", "search", "--onlyvisible", "--name", "skyview").split()
            if found and found[-1] == before:
                self.run("xdotool", "windowfocus", before)
                return before
            before = found[-1] if found else None
            time.sleep(0.2)
        return None

    def run(self, *command):
        """What a command prints; nothing where it does not end, as when the window has gone."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            return subprocess.run(command, env=self.environment, capture_output=True, text=True,
                                  timeout=120).stdout  # beside busy cores a picture takes 30 s
        return ""

    def key(self, name, times=1, wait=0.3):
        for _ in range(times):
            self.run("xdotool", "key", name)
            time.sleep(wait)

    def hold(self, name, seconds):
        self.run("xdotool", "keydown", name)
        time.sleep(seconds)
        self.run("xdotool", "keyup", name)

    def drag(self, start, end):
        self.run("xdotool", "mousemove", *map(str, start), "mousedown", "1")
        for step in range(1, 11):
            place = [round(a + (b - a) * step / 10) for a, b in zip(start, end)]
            self.run("xdotool", "mousemove", *map(str, place))
            time.sleep(0.05)
        self.run("xdotool", "mouseup", "1")

    def click(self, right, down, wait=0.5):
        self.run("xdotool", "mousemove", str(right), str(down))
        time.sleep(0.2)
        self.run("xdotool", "click", "1")
        time.sleep(wait)

    def shot(self, name, wait=1.0):
        """What the window shows, as PNG."""
        time.sleep(wait)
        if self.process.poll() is not None:
            return check(False, f"{name}: skyview has ended with {self.process.returncode}")
        file = self.folder / f"{name}.png"
        file.unlink(missing_ok=True)
        self.run("import", "-silent", "-window", self.window or "root", str(file))
        check(file.exists(), f"wrote {name}.png")

    def memory_kib(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1])

    def end(self, how=signal.SIGTERM):
        """@return exit status and what was printed."""
        if self.process.poll() is None and how is not None:
            self.process.send_signal(how)
        printed, _ = self.process.communicate(timeout=120)
        self.log.close()
        return self.process.returncode, printed.decode()


@contextlib.contextmanager
def flown(options, display, arguments, size=None, settle=6.0):
    """A flight whose first tables and terrain are there."""
    flight = Flight(options, display, arguments, size)
    check(flight.window is not None, f"a window opens: {' '.join(map(str, arguments))}")
    time.sleep(settle)
    try:
        yield flight
    finally:
        if flight.process.poll() is None:
            flight.end()


def differ(options, one, other):
    """Share of the pixels of two pictures that differ visibly; 0 where one is missing."""
    if not all((options.out / f"{name}.png").exists() for name in [one, other]):
        return 0.0
    done = subprocess.run(
        ["compare", "-metric", "AE", "-fuzz", "3%", options.out / f"{one}.png",
         options.out / f"{other}.png", "null:"], capture_output=True, text=True)
    size = subprocess.run(["identify", "-format", "%w %h", options.out / f"{one}.png"],
                          capture_output=True, text=True).stdout.split()
    pixels = float(re.match(r"[\d.e+]+", done.stderr)[0])
    return pixels / (int(size[0]) * int(size[1]))


def brightness(options, name):
    done = subprocess.run(["convert", options.out / f"{name}.png", "-format", "%[fx:mean]",
                           "info:"], capture_output=True, text=True)
    return float(done.stdout or 0.0)


def place(options):
    """The scene or the land that was given, or the made-up range."""
    if options.scene is not None:
        return [options.scene]
    return [] if options.dem is None else ["--dem", options.dem]


def start(options, display):
    """The first picture of the sky comes within a second of the window."""
    flight = Flight(options, display, [*place(options), "--time", "noon"])
    check(flight.window is not None, "a window opens")
    opened = time.monotonic() - flight.began
    print(f"  the window is there after {opened:.2f} s", flush=True)
    flight.shot("start-1s", wait=1.0)
    flight.shot("start-6s", wait=5.0)
    check(brightness(options, "start-1s") > 0.05, "there is a picture after a second")
    flight.end()


def keys(options, display):
    with flown(options, display, [*place(options), "--time", "sunset-1h"]) as flight:
        flight.shot("keys-before")
        for name, act in [
                ("forward", lambda: flight.hold("w", 2)), ("right", lambda: flight.hold("d", 1)),
                ("up", lambda: flight.hold("r", 2)), ("turned", lambda: flight.hold("Right", 1)),
                ("dragged", lambda: flight.drag((60, 60), (160, 90))),
                ("narrower", lambda: flight.key("x", 5)), ("wider", lambda: flight.key("X", 8)),
                ("sunset", lambda: flight.key("F7")), ("dusk", lambda: flight.key("F8")),
                ("sunrise", lambda: flight.key("F5")), ("noon", lambda: flight.key("F6")),
                ("brighter", lambda: flight.key("k", 3)), ("hazier", lambda: flight.key("Z", 5))]:
            act()
            flight.shot(f"keys-{name}", wait=2.0)
            check(differ(options, "keys-before", f"keys-{name}") > 0.001, f"{name} is seen")
        flight.key("Escape")
        time.sleep(1)
        flight.key("Escape")


def hud(options, display):
    with flown(options, display, [*place(options), "--time", "sunset-30m"]) as flight:
        flight.shot("hud")
        flight.key("h")
        flight.shot("hud-hidden")
        check(differ(options, "hud", "hud-hidden") > 0.002, "one key hides the instruments")
        flight.key("h")
        flight.key("question")
        flight.shot("hud-help")
        check(differ(options, "hud", "hud-help") > 0.05, "? shows the keys")
        flight.key("question")
        flight.key("F10")
        flight.shot("hud-panels")
        check(differ(options, "hud", "hud-panels") > 0.005, "F10 shows panels")
        for number, right in enumerate(options.menu):
            flight.click(right, 12)
            flight.shot(f"hud-panel-{number}")
        flight.key("Escape")
        flight.key("H")
        flight.shot("hud-night")


def time_rate(options, display):
    with flown(options, display, [*place(options), "--time", "sunset-20m"]) as flight:
        flight.shot("rate-before")
        flight.key("t", 3)
        flight.shot("rate-later", wait=10.0)
        check(differ(options, "rate-before", "rate-later") > 0.05, "time runs faster")
        flight.key("p")
        flight.shot("rate-paused")
        flight.shot("rate-still", wait=3.0)
        check(differ(options, "rate-paused", "rate-still") < 0.02, "pause stands still")


def aircraft(options, display):
    with flown(options, display, [*place(options), "--time", "sunset-1h"]) as flight:
        flight.key("2")
        flight.hold("Prior", 2)
        flight.shot("aircraft")
        flight.hold("Right", 1.5)
        flight.shot("aircraft-banked", wait=2.0)
        check(differ(options, "aircraft", "aircraft-banked") > 0.02, "the aircraft banks")
        flight.key("ctrl+a")
        flight.key("ctrl+h")
        flight.shot("aircraft-autopilot", wait=4.0)


def sizes(options, display):
    for size in ["320x240", "640x360", "1920x1080", "3840x2160"]:
        with flown(options, display, [*place(options), "--time", "sunset-30m"], size) as flight:
            flight.shot(f"size-{size}", wait=4.0)
            check(flight.process.poll() is None, f"{size} flies")
    with flown(options, display, [*place(options), "--time", "sunset-30m"]) as flight:
        for width, height in [(640, 360), (1, 1), (1280, 720)]:
            flight.run("xdotool", "windowsize", flight.window, str(width), str(height))
            time.sleep(2)
        flight.shot("size-resized", wait=3.0)
        flight.key("shift+F10")
        flight.shot("size-fullscreen", wait=4.0)
        flight.key("shift+F10")
        check(flight.process.poll() is None, "resizing and full screen end in peace")
    done = subprocess.run([options.skyview, "--size", "16384x16384"], capture_output=True,
                          env=dict(os.environ, DISPLAY=display.name), text=True)
    check(done.returncode == 2, f"16384x16384 ends with status {done.returncode}: {done.stderr}")


def screenshots(options, display):
    for picture in options.out.glob("skyview-*.*"):
        picture.unlink()
    with flown(options, display, [*place(options), "--time", "sunset-30m"]) as flight:
        for key, extension in [("F3", ".png"), ("shift+F3", ".exr")]:
            flight.key(key)
            until = time.monotonic() + 60
            while not (written := list(options.out.glob(f"skyview-*{extension}"))):
                if time.monotonic() > until:
                    break
                time.sleep(0.5)
            check(written, f"{key} writes {[picture.name for picture in written]}")


def record(options, display):
    """Two minutes recorded, replayed, rendered by skyseries, side by side."""
    track = options.out / "flight.csv"
    track.unlink(missing_ok=True)
    arguments = [*place(options), "--time", "sunset-30m"]
    flight = Flight(options, display, [*arguments, "--record", track])
    time.sleep(5)
    flight.key("t", 2)
    until = time.monotonic() + options.record_seconds
    while time.monotonic() < until:
        for key in ["w", "Right", "w", "r", "Left", "w"]:
            flight.hold(key, 1.0)
    status, _ = flight.end(signal.SIGINT)
    check(status == 130, f"SIGINT ends the flight with status {status}")
    lines = track.read_text().splitlines()
    check(len(lines) > 10, f"the record has {len(lines)} lines")
    replay(options, track, arguments)


def replay(options, track, arguments):
    small = ["--size", "640x360"]
    subprocess.run([options.skyview, *arguments, "--headless", *small, "--replay", track,
                    "--screenshot", options.out / "replay.%d.png", "--frames", "3"], check=True)
    series = pathlib.Path(options.skyview).parent.parent / "renderer" / "skyseries"
    scene = options.scene or options.out / "flight.toml"
    if options.scene is None:
        land = f'dem = "{options.dem}"' if options.dem else ""
        scene.write_text(f'[place]\nlatitude = {options.latitude}\n'
                         f'longitude = {options.longitude}\n'
                         f'[camera]\nabove_ground_m = 300.0\n[terrain]\n{land}\n')
    subprocess.run([series, scene, "--path", track, "--count", "3", *small, "--png", "--out",
                    options.out / "series.%d.exr"], check=True)
    pictures = [options.out / f"{name}.{i}.png" for i in range(3) for name in ["replay", "series"]]
    subprocess.run(["montage", *pictures, "-tile", "2x3", "-geometry", "+4+4",
                    options.out / "replay-and-series.png"], check=True)
    print("  wrote  replay-and-series.png: skyview to the left, skyseries to the right")
    film = subprocess.run([options.skyview, *arguments, "--headless", "--size", "320x180",
                           "--replay", track, "--video", options.out / "flight.mp4", "--fps", "5"])
    check(film.returncode == 0, "the replay becomes a film")


def lost(options, display):
    """Kills, and a display that goes."""
    for name, how, status in [("SIGTERM", signal.SIGTERM, 143), ("SIGKILL", signal.SIGKILL, -9)]:
        track = options.out / f"lost-{name}.csv"
        for file in [track, pathlib.Path(f"{track}.part")]:
            file.unlink(missing_ok=True)
        flight = Flight(options, display, [*place(options), "--record", track])
        time.sleep(8)
        ended, _ = flight.end(how)
        check(ended == status, f"{name} ends the flight with {ended}")
        left = track if how != signal.SIGKILL else pathlib.Path(f"{track}.part")
        check(left.exists() and len(left.read_text().splitlines()) > 1, f"{left.name} is there")
    own = Display("800x600")
    track = options.out / "lost-display.csv"
    flight = Flight(options, own, [*place(options), "--record", track], "640x360")
    time.sleep(8)
    own.close()
    ended, _ = flight.end(None)
    check(ended == 5, f"a display that goes ends the flight with status {ended}")
    check(track.exists(), "and its record is whole")


def dusk(options, display):
    """Ten minutes through dusk: memory and the worst frame."""
    seconds = 60.0 * options.minutes
    flight = Flight(options, display, [
        *place(options), "--time", options.dusk, "--benchmark", seconds, "--vsync", "off"])
    memory_kib = []
    while flight.process.poll() is None and time.monotonic() < flight.began + seconds + 120:
        time.sleep(1)
        with contextlib.suppress(FileNotFoundError, TypeError):
            memory_kib.append((time.monotonic() - flight.began, flight.memory_kib()))
    status, printed = flight.end(None)
    check(status == 0, f"the flight ends with status {status}")
    print(printed)
    # Maps that are made anew are there twice for a second: the median of half a minute.
    def around(age):
        return statistics.median([kib for at, kib in memory_kib if abs(at - age) <= 15.0])
    first, last = around(min(60.0, 0.2 * seconds)), around(memory_kib[-1][0] - 15.0)
    print(f"  memory {first / 1024:.0f} MiB after a minute, {last / 1024:.0f} MiB at the end")
    check(last <= 1.1 * first, f"memory at the end is {last / first:.3f} times that of the first minute")
    log = (options.out / "skyview.log").read_text().splitlines()
    worst = [line for line in log if "times the median" in line][-1]
    over = float(re.search(r"([\d.]+) times the median", worst)[1])
    check(over <= 3.0, worst)


FEATURES = {"start": start, "keys": keys, "hud": hud, "rate": time_rate, "aircraft": aircraft,
            "sizes": sizes, "screenshots": screenshots, "record": record, "lost": lost,
            "dusk": dusk}


def read_options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("skyview", type=lambda text: str(pathlib.Path(text).resolve()))
    parser.add_argument("out", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--dem", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--scene", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--size", default="1280x720", help="of windows whose size is no matter")
    parser.add_argument("--latitude", default=46.5, help="of the scene that skyseries renders")
    parser.add_argument("--longitude", default=8.0)
    parser.add_argument("--minutes", type=float, default=10.0, help="of the flight through dusk")
    parser.add_argument("--dusk", default="sunset-1h", help="when that flight begins")
    parser.add_argument("--record-seconds", type=float, default=120.0)
    parser.add_argument("--menu", type=lambda text: [int(x) for x in text.split(",")], default=[],
                        help="where to click into the menu of panels: pixels from the left")
    parser.add_argument("--only", default=",".join(FEATURES), help="of " + ", ".join(FEATURES))
    return parser.parse_args()


def main():
    options = read_options()
    options.out.mkdir(parents=True, exist_ok=True)
    display = Display("3840x2160")
    try:
        for name in options.only.split(","):
            print(f"== {name}", flush=True)
            FEATURES[name](options, display)
    finally:
        display.close()
    print(f"{len(FAULTS)} faults" + "".join(f"\n  {fault}" for fault in FAULTS))
    return 1 if FAULTS else 0


if __name__ == "__main__":
    sys.exit(main())
