#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the table of hard cases and their tests into tests/HARD_CASES.md.

A test that shows a hard case says so in the comment directly above it, in a line of its own:

    // Hard case 15.
    // Hard cases 4, 6.

The cases are rows of hard_cases.csv; its last column says what no test shows yet.
"""
import argparse
import csv
import pathlib
import re
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
DOCUMENT = FOLDER / "HARD_CASES.md"
BEGIN, END = "<!-- hard cases: begin -->", "<!-- hard cases: end -->"
TEST = re.compile(r"^(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\(\s*(\w+)\s*,\s*(\w+)")
MARK = re.compile(r"^// Hard cases? (\d+(?:, \d+)*)\.$")
LOOKS_LIKE_MARK = re.compile(r"^\s*//.*\bhard case", re.IGNORECASE)


class Fault(Exception):
    """What stands in the sources and cannot be."""


def cases():
    with open(FOLDER / "hard_cases.csv", newline="", encoding="utf-8") as file:
        return {int(row["number"]): row for row in csv.DictReader(file)}


def marks_of(file):
    """(number, suite, name) of every mark; a mark that belongs to no test is a fault."""
    found, pending = [], []
    for count, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        mark, test = MARK.match(line), TEST.match(line)
        if mark:
            pending += [int(number) for number in mark[1].split(", ")]
        elif test:
            found += [(number, test[1], test[2]) for number in pending]
            pending = []
        elif LOOKS_LIKE_MARK.match(line) or (pending and not line.startswith("//")):
            raise Fault(f"{file}:{count}: a hard case is not marked directly above a test")
    return found


def tests_by_case(known):
    tests = {number: [] for number in known}
    for file in sorted(FOLDER.rglob("*_test.cpp")):
        for number, suite, name in marks_of(file):
            if number not in tests:
                raise Fault(f"{file}: there is no hard case {number}")
            tests[number].append((file.relative_to(FOLDER).as_posix(), f"{suite}.{name}"))
    return tests


def table(known, tests):
    lines, group = [], None
    for number, case in known.items():
        if case["group"] != group:
            group = case["group"]
            lines += ["", f"### {group}", "", "| | what must hold | tests |", "|---:|---|---|"]
        links = [f"[{name}]({file})" for file, name in tests[number]]
        if case["missing"]:
            links.append(f"*not shown: {case['missing']}*")
        lines.append(f"| {number} | {case['what must hold']} | {'<br>'.join(links)} |")
    return "\n".join(lines[1:])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true",
                        help="change nothing; fail where a case has no test or the table is old")
    check = parser.parse_args().check
    known = cases()
    tests = tests_by_case(known)
    untested = [str(number) for number, found in tests.items() if not found]
    if check and untested:
        raise Fault(f"no test shows hard case {', '.join(untested)}")
    before = DOCUMENT.read_text(encoding="utf-8")
    head, rest = before.split(BEGIN)
    after = f"{head}{BEGIN}\n{table(known, tests)}\n{END}{rest.split(END)[1]}"
    if check and after != before:
        raise Fault("the table in tests/HARD_CASES.md is old; tests/hard_cases.py writes it anew")
    if not check:
        DOCUMENT.write_text(after, encoding="utf-8")


if __name__ == "__main__":
    try:
        main()
    except Fault as fault:
        sys.exit(f"hard_cases.py: {fault}")
