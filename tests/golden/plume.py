#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a scene and a grid for it: smoke from a fire, bent over by the wind, in a low sun.

The axis of the plume rises as that of a bent-over plume, z = 1.6 (F x^2)^(1/3) / u (Briggs 1969); its
radius grows by 0.5 of the height gained. Density falls off across it as a Gaussian and is torn by
gradient noise. At its foot a small glowing volume.

  plume.py --out DIR && skyseries DIR/plume.toml --out DIR/plume.exr --png
"""
import argparse
import math
import pathlib
import random
import struct

parser = argparse.ArgumentParser()
parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."))
parser.add_argument("--samples", type=int, default=64, help="of the grid, along the wind")
parser.add_argument("--time", default="2026-09-23T18:20:00+02:00")
options = parser.parse_args()
options.out.mkdir(parents=True, exist_ok=True)

NX, NY, NZ = options.samples // 2, options.samples, options.samples // 2
SIZE = (300.0, 640.0, 320.0)  # across the wind, along it, up [m]

rng = random.Random(4)
GRADIENTS = [tuple(rng.gauss(0, 1) for _ in range(3)) for _ in range(256)]
ORDER = list(range(256))
rng.shuffle(ORDER)


def noise(x, y, z):
    """Perlin's (1985, 2002), wavelength about 1.5, in (-1, 1)."""
    xi, yi, zi = math.floor(x), math.floor(y), math.floor(z)
    fx, fy, fz = x - xi, y - yi, z - zi
    fade = [t * t * t * (t * (t * 6 - 15) + 10) for t in (fx, fy, fz)]
    total = 0.0
    for dx in (0, 1):
        for dy in (0, 1):
            for dz in (0, 1):
                g = GRADIENTS[ORDER[(ORDER[(ORDER[(xi + dx) & 255] + yi + dy) & 255] + zi + dz)
                                    & 255]]
                weight = ((fade[0] if dx else 1 - fade[0]) * (fade[1] if dy else 1 - fade[1]) *
                          (fade[2] if dz else 1 - fade[2]))
                total += weight * (g[0] * (fx - dx) + g[1] * (fy - dy) + g[2] * (fz - dz))
    return total


def density(across, along, up):
    """At metres across the wind, downwind of the fire, and over the ground."""
    if along < 0.0:
        return 0.0
    height = 3.6 * along ** (2.0 / 3.0)
    radius = 6.0 + 0.34 * height
    q = (across * across + (up - height) ** 2) / (radius * radius)
    torn = sum(0.5 ** i * noise(across / radius * 1.7 * 2 ** i + 3.1 * i,
                                along / radius * 0.9 * 2 ** i, up / radius * 1.7 * 2 ** i)
               for i in range(3))
    body = math.exp(-1.6 * q) * (0.55 + 0.9 * torn) - 0.06
    end = min(1.0, (SIZE[1] - 20.0 - along) / 130.0)
    return max(0.0, body) * (14.0 / radius) ** 1.2 * end


values = []
for k in range(NZ):
    for j in range(NY):
        for i in range(NX):
            values.append(density((i + 0.5) / NX * SIZE[0] - SIZE[0] / 2,
                                  (j + 0.5) / NY * SIZE[1] - 20.0, (k + 0.5) / NZ * SIZE[2]))
(options.out / "plume.nrrd").write_bytes(
    f"NRRD0004\ntype: float\ndimension: 3\nsizes: {NX} {NY} {NZ}\nencoding: raw\nendian: little\n\n"
    .encode() + struct.pack(f"<{len(values)}f", *values))

LATITUDE, LONGITUDE = 47.46, 8.55
EAST = 1.0 / (111320.0 * math.cos(math.radians(LATITUDE)))  # degrees per metre
NORTH = 1.0 / 111132.0
FIRE = (900.0, 60.0)  # north and west of the eye; the wind blows to the east
(options.out / "plume.toml").write_text(f"""[place]
latitude = {LATITUDE}
longitude = {LONGITUDE}
zone = "Europe/Zurich"
[time]
utc = "{options.time}"
[camera]
height_m = 190
heading = 16
pitch = -4
fov = 46
[terrain]
none = true
[[volume]]
latitude = {LATITUDE + FIRE[0] * NORTH:.8f}
longitude = {LONGITUDE + (SIZE[1] / 2 - 20.0 - FIRE[1]) * EAST:.8f}
height_m = 0
size_m = [{SIZE[0]}, {SIZE[1]}, {SIZE[2]}]
heading = 90
grid = "plume.nrrd"
extinction_per_m = [0.26, 0.24, 0.22, 0.20]
albedo = [0.74, 0.78, 0.81, 0.83]
g = 0.55
[[volume]]
shape = "ellipsoid"
latitude = {LATITUDE + FIRE[0] * NORTH:.8f}
longitude = {LONGITUDE - FIRE[1] * EAST:.8f}
height_m = 0
size_m = [12, 12, 9]
extinction_per_m = 0.05
albedo = 0.2
temperature_k = 1150
""")
