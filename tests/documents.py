#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the Markdown files with the tree and with the programs.

- Every relative link leads to a file, and to a heading if it names one.
- Every path of a file or folder in backticks, or in parentheses in a diagram, exists. It is relative
  to the tree, to the document or to a layer; a name without a folder belongs to any file. Paths with
  capitals or * stand for many names; out/ and build/ hold outputs. CHANGELOG.md names former files.
- The table of tests/README.md has every header of tests/fixtures, and no others.
- A manual has every option that --help of its program prints, and no option that it does not print.
  Its row of an option has both ends of the range that --help prints.
- An option with a range refuses numbers below and above it, nan and words with status 2.
- skyseries accepts every command of it in the documents that needs no file: it lists the frames.
- The manuals of scene.toml and atmosphere.toml have every key that the readers accept. The readers
  list their keys in the message about an unknown one.
- The first example of README.md is the project in tests/consumer/readme.
"""
import argparse
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

TREE = pathlib.Path(__file__).resolve().parent.parent
UNKNOWN = "qqqqqqqqqqqqqqqq"
PLACE = "[place]\nlatitude = 46.5\nlongitude = 8.0\n"
FORMER = "CHANGELOG.md"
OUTPUTS = ("build/", "out/")
FOLDERS_OF_PATHS = ("", "include", "atmosphere", "lut", "renderer", "viewer", "tests")
SOURCES = "cpp|h|glsl|py|cmake"
SHARED = ("lut/MANUAL.md", "What the three programs share")
# Program, its manual, and its subcommands.
PROGRAMS = (
    ("skylut", "lut/MANUAL.md", ("sky", "build", "info", "eval", "report")),
    ("skyseries", "renderer/MANUAL.md", ("times", "report")),
    ("skyview", "viewer/MANUAL.md", ()),
)


def text_of(name):
    return (TREE / name).read_text(encoding="utf-8")


def documents():
    ignored = {"build", "out", ".git"}
    return [file for file in sorted(TREE.rglob("*.md"))
            if file.relative_to(TREE).parts[0] not in ignored]


def without_code(text):
    return re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)


def headings(text):
    return re.findall(r"^#+ +(.+?)\s*$", without_code(text), flags=re.MULTILINE)


def anchor_of(heading):
    """The anchor that GitHub gives to a heading."""
    kept = re.sub(r"[^\w\- ]", "", heading.lower())
    return kept.replace(" ", "-")


def faults_of_links():
    for file in documents():
        text = file.read_text(encoding="utf-8")
        for target in re.findall(r"\]\(([^)\s]+)\)", without_code(text)):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            linked = (file.parent / path).resolve() if path else file
            if not linked.exists():
                yield f"{file.relative_to(TREE)}: {target} does not exist"
            elif anchor and anchor not in map(anchor_of, headings(linked.read_text("utf-8"))):
                yield f"{file.relative_to(TREE)}: {target} names no heading"


def named_paths(text):
    for path in re.findall(r"`([^`\n]+)`", without_code(text)):
        if re.fullmatch(rf"[a-z0-9_.-]+(/[a-z0-9_.-]+)*(/|\.({SOURCES}))", path) \
                or re.fullmatch(r"[a-z0-9_.-]+(/[a-z0-9_.-]+)+\.[a-z]+", path):
            yield path
    for block in re.findall(r"^```text\n.*?^```", text, flags=re.MULTILINE | re.DOTALL):
        yield from re.findall(rf"\(([a-z0-9_./-]+\.(?:{SOURCES}))\)", block)


def faults_of_paths():
    names = {file.name for folder in FOLDERS_OF_PATHS[1:] for file in (TREE / folder).rglob("*")}
    names |= {file.name for file in TREE.iterdir()}
    for document in documents():
        name = document.relative_to(TREE).as_posix()
        if name == FORMER:
            continue
        folders = [document.parent] + [TREE / folder for folder in FOLDERS_OF_PATHS]
        for path in dict.fromkeys(named_paths(document.read_text(encoding="utf-8"))):
            if path.startswith(OUTPUTS) or ("/" not in path and path in names):
                continue
            if not any((folder / path).exists() for folder in folders):
                yield f"{name}: {path} does not exist"


def faults_of_fixtures():
    text = text_of("tests/README.md")
    table = text[text.index("| fixture |"):]
    listed = set(re.findall(r"`([a-z_]+\.h)`",
                            " ".join(re.findall(r"^\| ([^|]*)\|", table, flags=re.MULTILINE))))
    present = {file.name for file in (TREE / "tests" / "fixtures").glob("*.h")}
    for header in sorted(listed ^ present):
        fault = "is not in the table" if header in present else "does not exist"
        yield f"tests/README.md: fixtures/{header} {fault}"


def section(text, heading):
    """The text below a heading, up to the next heading of its level or above."""
    found = re.search(rf"^(#+) +{re.escape(heading)}.*$", text, flags=re.MULTILINE)
    if not found:
        return ""
    rest = text[found.end():]
    after = re.search(rf"^#{{1,{len(found[1])}}} ", without_comments_in_code(rest), re.MULTILINE)
    return rest[:after.start()] if after else rest


def without_comments_in_code(text):
    """The same length; code blocks are blank, because their comments look like headings."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match[0])
    return re.sub(r"^```.*?^```", blank, text, flags=re.MULTILINE | re.DOTALL)


def options_of_help(program, subcommand):
    """The ends of the range of each option; None for an option without a range."""
    command = [program] + ([subcommand] if subcommand else []) + ["--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    options = {}
    for line in done.stdout.splitlines():
        if re.match(r"^\s+-", line):
            ends = re.search(r"in \[(\S+) - (\S+)\]", line)
            for option in re.findall(r"--[a-z][a-z0-9-]*", line.split()[0]):
                options[option] = (float(ends[1]), float(ends[2])) if ends else None
    if "--help" not in options:
        raise ValueError(f"{' '.join(command)} lists no options")
    return options


def numbers_of_row(text, option):
    """The numbers in the first row of a table whose first column has the option."""
    row = re.search(rf"^\| [^|]*`{option}[` ][^\n]*", text, flags=re.MULTILINE)
    numbers = re.findall(r"-?\d+(?:\.\d+)?(?:e\d+)?", row[0]) if row else []
    return [float(number) for number in numbers]


def options_of_manual(text):
    """Those in the first column of a table."""
    cells = re.findall(r"^\| ([^|]*`--[^|]*)\|", text, flags=re.MULTILINE)
    return {option for cell in cells for option in re.findall(r"--[a-z][a-z0-9-]*", cell)}


def faults_of_options(programs):
    of_all = section(text_of(SHARED[0]), SHARED[1])
    shared = options_of_manual(of_all)
    for name, manual, subcommands in PROGRAMS:
        if name not in programs:
            continue
        text = text_of(manual)
        printed = set()
        for subcommand in ("",) + subcommands:
            of_help = options_of_help(programs[name], subcommand)
            printed |= of_help.keys()
            called = f"{name} {subcommand}".strip()
            part = section(text, called) if subcommand else text
            for option in sorted(of_help.keys() - shared):
                if not re.search(rf"`{option}[`=\s]", part):
                    yield f"{manual}: {option} of {called} is missing"
            for option, ends in of_help.items():
                stated = numbers_of_row(part, option) + numbers_of_row(of_all, option)
                for end in sorted(set(ends or ()) - set(stated)):
                    yield f"{manual}: {option} of {called} lacks the end {end:g} of its range"
        for option in sorted(options_of_manual(text) - printed - shared):
            yield f"{manual}: {name} has no option {option}"


# Options without which a command ends before it looks at the values of others.
NEEDED = {
    "skylut sky": {"--out": "q.exr", "--sun-elevation": "10"},
    "skylut build": {"--out": "q"},
    "skylut eval": {"--out": "q", "--cases": "q", "--method": "integral"},
    "skyseries": {"--list": "", "--at": "noon", "--place": "Zurich"},
    "skyseries times": {"--place": "Zurich"},
    "skyview": {"--headless": "", "--benchmark": "1"},
}


def refused(ends):
    """Values that an option with a range refuses."""
    return (f"{ends[0] - 1:g}", f"{ends[1] + abs(ends[1]) + 1:g}", "nan", UNKNOWN)


def faults_of_ranges(programs, folder):
    for called, needed in NEEDED.items():
        name, *subcommand = called.split()
        if name not in programs:
            continue
        program = str(pathlib.Path(programs[name]).resolve())
        for option, ends in options_of_help(program, "".join(subcommand)).items():
            for value in refused(ends) if ends else ():
                given = {**needed, option: value}
                command = [program, *subcommand, *(f"{key}={of}" if of else key for key, of in given.items())]
                done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
                if done.returncode != 2 or value not in done.stderr:
                    yield f"{called} {option}={value} ends with {done.returncode}: {done.stderr.strip()}"


def commands_in(text):
    """The commands in the code blocks of a shell, as lists of words."""
    for block in re.findall(r"^```sh\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines():
            yield shlex.split(line, comments=True)


def faults_of_commands(skyseries, folder):
    for document in documents():
        name = document.relative_to(TREE).as_posix()
        for words in commands_in(document.read_text(encoding="utf-8")):
            needs_files = any(re.search(r"\$|\.(toml|csv)$|^report$", word) for word in words)
            if not words or pathlib.Path(words[0]).name != "skyseries" or needs_files:
                continue
            arguments = words[1:] if words[1] == "times" else words[1:] + ["--list"]
            done = subprocess.run([skyseries, *arguments], capture_output=True, text=True,
                                  check=False, cwd=folder)
            if done.returncode != 0:
                yield f"{name}: {shlex.join(words)} ends with {done.returncode}: {done.stderr}"


def keys_known(skyseries, folder, table, in_atmosphere):
    """The keys that a reader accepts in a table ("" for the top level); none for a plain key."""
    unknown = f"{table}\n{UNKNOWN} = 1\n" if table else f"{UNKNOWN} = 1\n"
    scene = folder / "scene.toml"
    if in_atmosphere:
        (folder / "air.toml").write_text(unknown, encoding="utf-8")
        scene.write_text(PLACE + '[atmosphere]\nfile = "air.toml"\n', encoding="utf-8")
    else:
        place = "" if not table or table == "[place]" else PLACE
        scene.write_text(place + unknown, encoding="utf-8")
    done = subprocess.run([skyseries, str(scene), "--list", "--at", "2026-06-21T12:00:00Z"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 3:
        raise ValueError(f"{table or 'top level'}: an unknown key ends with {done.returncode}")
    known = re.search(r"known are (.*)", done.stderr)
    return [key.strip() for key in known[1].split(",")] if known else []


def scene_tables(block):
    """The parts of the block of TOML in the manual, by the name of the table."""
    parts = re.split(r"^(?:# )?(\[+\w+\]+).*$", block, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def faults_of_scene_keys(skyseries, folder):
    manual = "renderer/MANUAL.md"
    block = re.search(r"^```toml\n(.*?)^```", text_of(manual), re.MULTILINE | re.DOTALL)[1]
    tables = scene_tables(block)
    for name in keys_known(skyseries, folder, "", False):
        header = next((known for known in tables if known.strip("[]") == name), None)
        if header is None:
            yield f"{manual}: the table {name} of scene.toml is missing"
            continue
        for key in keys_known(skyseries, folder, header, False):
            if not re.search(rf"(?:^|[ (]){key} = ", tables[header], flags=re.MULTILINE):
                yield f"{manual}: {name}.{key} of scene.toml is missing"


def faults_of_atmosphere_keys(skyseries, folder):
    manual = "atmosphere/ATMOSPHERE_FILE.md"
    text = text_of(manual)
    for name in keys_known(skyseries, folder, "", True):
        keys = keys_known(skyseries, folder, f"[{name}]", True)
        part = section(text, f"`[{name}]`" if keys else "Top level")
        first_column = " ".join(re.findall(r"^\| ([^|]*)\|", part, flags=re.MULTILINE))
        for key in keys or [name]:
            if f"`{key}`" not in first_column:
                yield f"{manual}: {key} of [{name}] is missing"


def faults_of_example():
    consumer = TREE / "tests" / "consumer" / "readme"
    built = {"cpp": consumer / "sky_radiance.cpp", "cmake": consumer / "CMakeLists.txt"}
    for language, file in built.items():
        shown = re.search(rf"^```{language}\n(.*?)^```", text_of("README.md"),
                          flags=re.MULTILINE | re.DOTALL)
        lines = file.read_text(encoding="utf-8").splitlines()
        for line in shown[1].splitlines() if shown else ["an example"]:
            if line not in lines:
                yield f"README.md: {file.relative_to(TREE)} does not have: {line}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, _, _ in PROGRAMS:
        parser.add_argument(f"--{name}", help="the program")
    arguments = vars(parser.parse_args())
    programs = {name: path for name, path in arguments.items() if path}
    faults = [*faults_of_links(), *faults_of_paths(), *faults_of_fixtures(), *faults_of_example(),
              *faults_of_options(programs)]
    with tempfile.TemporaryDirectory() as folder:
        faults += faults_of_ranges(programs, pathlib.Path(folder))
    if "skyseries" in programs:
        with tempfile.TemporaryDirectory() as folder:
            skyseries = pathlib.Path(programs["skyseries"]).resolve()
            for faults_of in (faults_of_scene_keys, faults_of_atmosphere_keys, faults_of_commands):
                faults += faults_of(skyseries, pathlib.Path(folder))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
