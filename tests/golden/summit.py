#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a scene and its mesh: rocks on a summit, an arm's length away, before ranges of mountains.

A lens that is in focus on the rocks blurs the ranges, or the other way round:

  summit.py --focus 6 > summit.toml && skyseries summit.toml --samples 64 --out summit.exr --png

The mesh, summit.obj, is polar about the eye, so that its steps grow with distance, and reaches to 40
km; its heights are ridged noise (Musgrave 1994), curved down as the earth is.
"""
import argparse
import math

parser = argparse.ArgumentParser()
parser.add_argument("--focus", type=float, default=6.0, help="distance of what is sharp [m]")
parser.add_argument("--f-number", type=float, default=2.0, help="0: a pinhole")
parser.add_argument("--blades", type=int, default=7, help="of the iris")
parser.add_argument("--mesh", default="summit.obj", help="written here")
options = parser.parse_args()

COLUMNS, ROWS, NEAR_ROWS = 520, 640, 260
HEADING, SPREAD = math.radians(200.0), math.radians(40.0)
NEAREST, BEYOND_ROCKS, FARTHEST = 4.0, 14.0, 40e3
SUMMIT, VALLEY = 2600.0, 900.0


def lattice(i, j, seed):
    h = (i * 0x9E3779B1 ^ j * 0x85EBCA77 ^ seed * 0xC2B2AE3D) & 0xFFFFFFFF
    h = ((h ^ h >> 16) * 0x85EBCA6B) & 0xFFFFFFFF
    h = ((h ^ h >> 13) * 0xC2B2AE35) & 0xFFFFFFFF
    return (h ^ h >> 16) / 4294967296.0


def noise(x, y, seed):
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3.0 - 2.0 * u), v * v * (3.0 - 2.0 * v)
    a = lattice(i, j, seed) * (1.0 - u) + lattice(i + 1, j, seed) * u
    b = lattice(i, j + 1, seed) * (1.0 - u) + lattice(i + 1, j + 1, seed) * u
    return a * (1.0 - v) + b * v


def ridges(x, y, wavelength, shortest, roughness, seed):
    """In [0, 1], sharp at the top; octaves down to the shortest wavelength."""
    total, weight, amplitude, scale = 0.0, 1.0, 1.0, 0.0
    while wavelength > shortest and amplitude > 0.003:
        turn = 0.7 * seed
        c, s = math.cos(turn), math.sin(turn)
        crest = 1.0 - abs(2.0 * noise((c * x - s * y) / wavelength, (s * x + c * y) / wavelength, seed) - 1.0)
        total += amplitude * weight * crest * crest
        scale += amplitude
        weight = min(1.0, 0.4 + 1.2 * crest)
        wavelength, amplitude, seed = 0.47 * wavelength, roughness * amplitude, seed + 1
    return total / scale if scale > 0.0 else 0.0


def distance(row):
    if row < NEAR_ROWS:
        return NEAREST + (BEYOND_ROCKS - NEAREST) * row / NEAR_ROWS
    return BEYOND_ROCKS * (FARTHEST / BEYOND_ROCKS) ** ((row - NEAR_ROWS) / (ROWS - NEAR_ROWS))


def height(x, y):
    r = math.hypot(x, y)
    step = 0.12 if r < BEYOND_ROCKS else 4.0 * r * math.log(FARTHEST / BEYOND_ROCKS) / (ROWS - NEAR_ROWS)
    ranges = VALLEY + 2300.0 * ridges(x, y, 11000.0, max(step, 60.0), 0.48, 11) * min(1.0, r / 6000.0)
    cone = SUMMIT - 0.5 * (math.hypot(r, 14.0) - 14.0) - 0.0003 * r * r + 14.0 * (ridges(x, y, 160.0, max(step, 4.0), 0.5, 31) - 0.5) * min(
        1.0, r / 40.0)
    k = 120.0
    z = k * math.log(math.exp((cone - 3000.0) / k) + math.exp((ranges - 3000.0) / k)) + 3000.0
    if r < 200.0:
        z += 0.5 * ridges(x, y, 3.0, step, 0.55, 51)
        for ahead, right, high, wide in ((6.4, -1.15, 1.75, 1.25), (7.0, 0.35, 1.05, 0.8), (8.0, 1.5, 0.8, 0.7), (12.0, 3.4, 1.6, 1.7)):
            u = ahead * math.sin(HEADING) + right * math.cos(HEADING)
            v = ahead * math.cos(HEADING) - right * math.sin(HEADING)
            bend = 0.3 * noise(1.6 * x, 1.6 * y, 91) + 0.08 * noise(6.0 * x, 6.0 * y, 92) - 0.2
            d = math.hypot(x - u, y - v) / wide + bend
            if d < 1.0:
                z += high * (1.0 - max(d, 0.0) ** 2) ** 0.6 + 0.12 * min(1.0, 4.0 * (1.0 - d)) * (
                    ridges(x, y, 0.9, step, 0.6, 71) - 0.5)
    return z - r * r / (2.0 * 6371000.0)


with open(options.mesh, "w") as mesh:
    for row in range(ROWS + 1):
        r = distance(row)
        for column in range(COLUMNS + 1):
            angle = HEADING + SPREAD * (2.0 * column / COLUMNS - 1.0)
            x, y = r * math.sin(angle), r * math.cos(angle)
            mesh.write(f"v {x:.3f} {y:.3f} {height(x, y):.3f}\n")
    for row in range(ROWS):
        for column in range(COLUMNS):
            a = row * (COLUMNS + 1) + column + 1
            b = a + COLUMNS + 1
            mesh.write(f"f {a} {a + 1} {b + 1} {b}\n")

print(f"""[place]
latitude = 46.5
longitude = 8.0
[time]
utc = "2026-06-21T16:50:00Z"
[camera]
height_m = {height(0.0, 1e-9) + 1.7:.2f}
heading = 195
pitch = -4
sensor_width_mm = 36
focal_length_mm = 85""")
if options.f_number > 0.0:
    print(f"f_number = {options.f_number}\nfocus_m = {options.focus}\nblades = {options.blades}\nblade_rotation = 8")
print(f"[terrain]\nmesh = \"{options.mesh}\"")
