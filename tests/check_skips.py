#!/usr/bin/env python3
"""Fails when a test was skipped for a reason that tests/allowed_skips.txt does not list.

Usage: check_skips.py LINES.xml FOLDER   (what ctest --output-junit wrote, and the folder of the results that
each line of CTest that runs GoogleTest writes)
"""
import pathlib
import re
import sys
import xml.etree.ElementTree


def allowed_reasons():
    lines = (pathlib.Path(__file__).parent / "allowed_skips.txt").read_text().splitlines()
    return [re.compile(line) for line in lines if line and not line.startswith("#")]


def skipped_lines(results):
    """Yields the name and the output of every line of CTest that was skipped or did not run."""
    for case in xml.etree.ElementTree.parse(results).getroot().iter("testcase"):
        if case.find("skipped") is not None or case.get("status") in ("notrun", "disabled"):
            yield case.get("name"), case.findtext("system-out") or ""


def tests_of(folder):
    """Yields every result of a single test, with the name of its line."""
    for file in sorted(pathlib.Path(folder).glob("*.xml")):
        for case in xml.etree.ElementTree.parse(file).getroot().iter("testcase"):
            yield f'{file.stem}.{case.get("name")}', case


def main():
    lines, folder = sys.argv[1:]
    reasons = allowed_reasons()
    tests = list(tests_of(folder))
    if not tests:
        sys.exit(f"{folder} has no results")
    skipped = list(skipped_lines(lines))
    for name, case in tests:
        reason = case.find("skipped")
        if reason is not None or case.get("status") == "notrun":
            skipped.append((name, "" if reason is None else reason.get("message")))
    refused = [(name, output) for name, output in skipped
               if not any(reason.search(output) for reason in reasons)]
    for name, output in refused:
        print(f"skipped without a reason listed in tests/allowed_skips.txt: {name}\n{output}")
    print(f"{len(tests)} tests; {len(skipped)} skipped, {len(refused)} of them for a reason that is not listed")
    sys.exit(1 if refused else 0)


if __name__ == "__main__":
    main()
