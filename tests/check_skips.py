#!/usr/bin/env python3
"""Fails when a test was skipped for a reason that tests/allowed_skips.txt does not list.

Usage: check_skips.py RESULTS.xml   (what ctest --output-junit wrote)
"""
import pathlib
import re
import sys
import xml.etree.ElementTree


def allowed_reasons():
    lines = (pathlib.Path(__file__).parent / "allowed_skips.txt").read_text().splitlines()
    return [re.compile(line) for line in lines if line and not line.startswith("#")]


def skipped_tests(results):
    """Yields the name and the output of every test that was skipped or did not run."""
    for case in xml.etree.ElementTree.parse(results).getroot().iter("testcase"):
        if case.find("skipped") is not None or case.get("status") in ("notrun", "disabled"):
            yield case.get("name"), case.findtext("system-out") or ""


def main():
    reasons = allowed_reasons()
    skipped = list(skipped_tests(sys.argv[1]))
    refused = [(name, output) for name, output in skipped
               if not any(reason.search(output) for reason in reasons)]
    for name, output in refused:
        print(f"skipped without a reason listed in tests/allowed_skips.txt: {name}\n{output}")
    print(f"{len(skipped)} tests skipped, {len(refused)} of them for a reason that is not listed")
    sys.exit(1 if refused else 0)


if __name__ == "__main__":
    main()
