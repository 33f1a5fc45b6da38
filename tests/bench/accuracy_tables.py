#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the figures of lut/ACCURACY.md and the table of README.md from two reports.

    skylut report --out out/report
    skyseries report --out out/pictures
    python3 tests/bench/accuracy_tables.py out/report out/pictures

The first two columns of a row in ACCURACY.md name a topic, its air and a method of a report; all other
columns are written anew. A row that no report has is an error. Plots are copied, too. Sentences outside
the tables, such as the bullets of README.md, are left to whoever runs this.
"""
import argparse
import csv
import pathlib
import re
import shutil
import sys

TREE = pathlib.Path(__file__).resolve().parents[2]
TOPICS = {  # as ACCURACY.md calls them: as the reports do
    "transmittance": "Transmittance", "single scattering": "Single scattering",
    "all orders": "All orders", "panorama": "Panoramas", "refraction": "Refraction",
    "air before a mountain": "Aerial perspective", "shafts": "Shafts", "a lamp in fog": "A lamp in fog",
    "many lamps in fog": "Many lamps in fog", "a picture": "Whole pictures"}
# Rows of README.md: the names of a topic and air, and the methods of the four columns.
README_ROWS = {
    "single scattering, clear": ("single scattering, earth",
                                 "direct integration, normal, 14 nodes a panel",
                                 "direct integration, fast, 7 nodes a panel",
                                 "4-D table (Bruneton), 32 x 128 x 32 x 8", None),
    "all orders, clear": ("all orders, earth", "moments on direct nodes, normal",
                          "moments on direct nodes, fast", None,
                          "isotropic table (Hillaire 2020), 32 x 32, 64 directions"),
    "all orders, hazy": ("all orders, hazy", "moments to degree 12, forward peak apart, 18 x 32", None,
                         None, "isotropic table (Hillaire 2020), 32 x 32, 64 directions"),
    "sky around one camera, clear": ("panorama, earth", "sky view, in rows, size chosen", None, None,
                                     None),
    "air before a mountain, clear": ("air before a mountain, earth", "direct integration, automatic",
                                     None, "two look-ups (Bruneton), 32 x 128 x 32 x 8",
                                     "froxels (Hillaire 2020), 32 x 32 x 32")}
README_REGIMES = ("day", "sunset", "twilight")
CSV_FILES = {"single scattering": "single_scattering", "all orders": "all_orders", "panorama": "panoramas",
             "air before a mountain": "aerial_perspective"}
PLOTS = (("report", "single_scattering.earth.svg", "lut/single_scattering.svg"),
         ("pictures", "shafts.*.svg", "renderer/shafts.svg"))


def cells_of(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


class Summary:
    """The tables of a report's summary.md: (topic, its place) to methods to columns."""

    def __init__(self, folder):
        text = (folder / "summary.md").read_text(encoding="utf-8")
        self.maker = text.strip().splitlines()[-1]
        self.tables = []
        for part in re.split(r"^(?=\*\*)", text, flags=re.MULTILINE):
            title = re.match(r"\*\*(.+?)\*\*\. (.*)", part)
            if not title:
                continue
            rows = [cells_of(line) for line in part.splitlines() if line.startswith("|")]
            self.tables.append((title[1], title[2], rows[0], {row[0]: row for row in rows[2:]}))

    def row(self, topic, air, method):
        """The header and the cells of a method, or None."""
        for title, place, header, methods in self.tables:
            of_air = not air or re.search(rf"Atmosphere {re.escape(air)}(:| |;)", place)
            if title == topic and of_air and method in methods:
                return header, methods[method]
        return None


def times_of(folder):
    """Seconds of an answer by (atmosphere, method, regime)."""
    times = {}
    for file in folder.glob("*.csv"):
        with file.open(encoding="utf-8", newline="") as lines:
            for row in csv.DictReader(lines):
                if row.get("time_s"):
                    method = ", ".join(filter(None, (row["series"], row["parameter"])))
                    times[file.stem, row["atmosphere"], method, row["regime"]] = float(row["time_s"])
    return times


def time_text(seconds):
    """Two digits, in ns or µs."""
    value, unit = (seconds * 1e9, "ns") if seconds < 9.95e-7 else (seconds * 1e6, "µs")
    return f"{float(f'{value:.2g}'):g} {unit}"


class Reports:
    def __init__(self, folders):
        self.summaries = [Summary(folder) for folder in folders]
        self.times = {key: time for folder in folders for key, time in times_of(folder).items()}

    def slowest(self, what, method):
        """Time of an answer in the slowest of the regimes that README.md shows."""
        topic, _, air = what.partition(", ")
        found = [self.times[CSV_FILES[topic], air, method, regime] for regime in README_REGIMES]
        return time_text(max(found))

    def row(self, what, method):
        topic, _, air = what.partition(", ")
        if topic not in TOPICS:
            raise ValueError(f"no topic is called {topic!r}")
        for summary in self.summaries:
            found = summary.row(TOPICS[topic], air, method)
            if found:
                return found
        raise ValueError(f"no report has {what!r} by {method!r}")


def short(column):
    """'Day: sun above 5°' is 'day' in a list of errors."""
    name = column.partition(":")[0]
    return name[0].lower() + name[1:]


def sky_row(reports, what, method):
    """Memory, time to make, time, and errors by day, at sunset, in twilight and from space."""
    _, row = reports.row(what, method)
    return row[1:9]


def picture_row(reports, what, method):
    """Time to make, time, and the errors of all columns of the report."""
    header, row = reports.row(what, method)
    errors = ", ".join(f"{short(name)} {value}" for name, value in zip(header[4:], row[4:]) if value)
    return row[2], row[3], errors


def with_rows(text, header, make):
    """Writes every row of the table below `header` anew; the separator stays."""
    before, found, rest = text.partition(header + "\n")
    if not found:
        raise ValueError(f"no table begins with {header!r}")
    separator, *lines = rest.split("\n")
    count = next(i for i, line in enumerate(lines) if not line.startswith("|"))
    rows = ["| " + " | ".join(make(cells_of(line))) + " |" for line in lines[:count]]
    return before + found + "\n".join([separator, *rows, *lines[count:]])


def accuracy(text, reports):
    for header, columns in (
            ("| what, air | method | memory | made in | time | day | sunset | twilight to -6° | -6° to -12° "
             "| from space |", sky_row),
            ("| what | method | made in | time | errors |", picture_row)):
        text = with_rows(text, header, lambda cells, columns=columns: (
            cells[0], cells[1], *columns(reports, cells[0], cells[1])))
    maker = reports.summaries[0].maker
    machine, date = maker.partition(";")[0], re.search(r"\d{4}-\d\d-\d\d", maker)[0]
    return re.sub(r"^Machine: .*$", f"Machine: {machine}; {date}.", text, count=1, flags=re.MULTILINE)


def readme_cell(reports, what, method):
    if not method:
        return ""
    _, row = reports.row(what, method)
    rms = [value.partition(" % /")[0] if value else "-" for value in row[4:7]]
    parts = [" / ".join(rms) + " %", reports.slowest(what, method)] + ([row[1]] if row[1] != "-" else [])
    return ", ".join(parts)


def readme(text, reports):
    def make(cells):
        what, *methods = README_ROWS[cells[0]]
        return (cells[0], *(readme_cell(reports, what, method) for method in methods))
    return with_rows(text, "| quantity | Alpenglow | Alpenglow, fast | Bruneton 2017 | Hillaire 2020 |", make)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("report", type=pathlib.Path, help="folder of skylut report")
    parser.add_argument("pictures", type=pathlib.Path, help="folder of skyseries report")
    folders = parser.parse_args()
    reports = Reports([folders.report, folders.pictures])
    for name, write in (("lut/ACCURACY.md", accuracy), ("README.md", readme)):
        file = TREE / name
        file.write_text(write(file.read_text(encoding="utf-8"), reports), encoding="utf-8")
    for folder, pattern, target in PLOTS:
        found = [plot for plot in getattr(folders, folder).glob(pattern)
                 if not plot.name.endswith(".samples.svg")]
        if len(found) != 1:
            raise ValueError(f"{pattern}: {len(found)} plots, not one")
        shutil.copyfile(found[0], TREE / target)


if __name__ == "__main__":
    try:
        main()
    except ValueError as error:
        sys.exit(f"accuracy_tables: {error}")
