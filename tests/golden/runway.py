#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a scene: a runway at night in height fog, seen from an aeroplane on its final approach.

Edge lights every 60 m, threshold, end and approach lights as on a precision runway (ICAO Annex 14,
volume I, chapter 5), and the landing light of the aeroplane ahead or of the eye's own.

  runway.py --eye grass > runway.toml && skyseries runway.toml --out runway.exr --png --exposure 2
"""
import argparse
import math

parser = argparse.ArgumentParser()
parser.add_argument("--length", type=float, default=1800.0, help="of the runway [m]")
parser.add_argument("--lamps", type=int, help="that many lamps instead, along the edges")
parser.add_argument("--visibility", type=float, default=900.0, help="in the fog at the ground [m]")
parser.add_argument("--scale-height", type=float, default=25.0, help="of the fog [m]")
parser.add_argument("--eye", choices=["approach", "grass"], default="approach")
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


# (x, y) of the eye, its height and where it looks: from the glide path, or from the grass beside
# the runway towards an aeroplane that lands.
EYES = {"approach": (-420.0, 0.0, 38.0, 90.0, -4.0, 50.0),
        "grass": (620.0, -75.0, 6.0, 289.0, 1.5, 52.0)}
eye_x, eye_y, eye_height, heading, pitch, fov = EYES[options.eye]

print(f"""[place]
latitude = {LATITUDE + eye_y * NORTH:.8f}
longitude = {LONGITUDE + eye_x * EAST:.8f}
zone = "Europe/Zurich"
[time]
local = "2026-01-15T23:30:00"
[camera]
height_m = {eye_height}
heading = {heading}
pitch = {pitch}
fov = {fov}
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
    # An aeroplane over the threshold with its landing lights on; its position lights are red, green
    # and white.
    for side in (-6.0, 6.0):
        lamp(180.0, side, 400000.0, 4200.0, 24.0,
             'type = "spot"\nheading = 90.0\npitch = -4.0\ncone = [2.5, 6.0]\n')
    lamp(170.0, 15.0, 40.0, 1000.0, 24.5)
    lamp(170.0, -15.0, 40.0, 9000.0, 24.5)
