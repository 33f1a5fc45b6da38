#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a scene: a runway at night in height fog, seen from an aeroplane on its final approach.

Edge lights every 60 m, threshold, end and approach lights as on a precision runway (ICAO Annex 14,
volume I, chapter 5), and the landing light of the aeroplane ahead or of the eye's own.

  runway.py > runway.toml && skyseries runway.toml --out runway.exr --png --night-vision
"""
import argparse
import math

parser = argparse.ArgumentParser()
parser.add_argument("--length", type=float, default=1800.0, help="of the runway [m]")
parser.add_argument("--lamps", type=int, help="that many lamps instead, along the edges")
parser.add_argument("--visibility", type=float, default=900.0, help="in the fog at the ground [m]")
parser.add_argument("--scale-height", type=float, default=25.0, help="of the fog [m]")
parser.add_argument("--no-beam", action="store_true", help="without landing lights")
options = parser.parse_args()

LATITUDE, LONGITUDE = 47.46, 8.55
EAST = 1.0 / (111320.0 * math.cos(math.radians(LATITUDE)))  # degrees per metre
NORTH = 1.0 / 111132.0
WHITE, RED, GREEN_K = 3000.0, 1200.0, 6500.0


def lamp(x, y, candela, kelvin=WHITE, height=0.35, extra=""):
    """x along the runway from its threshold, y to the left; the runway points east."""
    print(f"[[light]]\nlatitude = {LATITUDE + y * NORTH:.8f}\n"
          f"longitude = {LONGITUDE + x * EAST:.8f}\nabove_ground_m = {height}\n"
          f"intensity_cd = {candela}\ntemperature_k = {kelvin}\nradius_m = 0.1\n{extra}")


print(f"""[place]
latitude = {LATITUDE}
longitude = {LONGITUDE - 420.0 * EAST:.8f}
zone = "Europe/Zurich"
[time]
local = "2026-01-15T23:30:00"
[camera]
height_m = 38.0
heading = 90.0
pitch = -4.0
fov = 50.0
[terrain]
none = true
[fog]
visibility_m = {options.visibility}
scale_height_m = {options.scale_height}
base_height_m = 0.0
droplet_diameter_um = 12.0
""")

if options.lamps:
    for i in range(options.lamps):
        side = 1 if i % 2 else -1
        lamp(options.length * (i // 2) / max(1, options.lamps // 2), side * 23.0, 600.0)
else:
    for i in range(int(options.length // 60) + 1):
        for side in (-1, 1):
            lamp(60.0 * i, side * 23.0, 800.0)
    for i in range(int(options.length // 30)):
        lamp(30.0 * i, 0.0, 500.0)
    for i in range(-7, 8):
        lamp(0.0, 3.0 * i, 700.0, GREEN_K)
        lamp(options.length, 3.0 * i, 250.0, RED)
    for i in range(1, 11):
        for j in (-2, -1, 0, 1, 2):
            lamp(-30.0 * i, 1.2 * j, 900.0, 3400.0, 1.0)

if not options.no_beam:
    # An aeroplane ahead, low over the threshold, with its landing lights on.
    for side in (-1, 1):
        lamp(120.0, 5.0 * side, 300000.0, 4000.0, 14.0,
             'type = "spot"\nheading = 90.0\npitch = -5.0\ncone = [3.0, 8.0]\nradius_m = 0.15\n'.replace(
                 "radius_m = 0.15\n", ""))
    lamp(140.0, 70.0, 60000.0, 4000.0, 12.0,
         'type = "spot"\nheading = 200.0\npitch = -6.0\ncone = [4.0, 9.0]\n')
