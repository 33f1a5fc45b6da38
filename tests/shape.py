#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints how large the code is and how it is divided, and fails where a rule that protects a reader is broken.

    python3 tests/shape.py                # all rows
    python3 tests/shape.py --build build/ci    # with the size of the build

LIMITS holds these rules. Numbers of files and lines have no limit: they inform.
The rules that hold without exception (folder order, namespaces) are in source_rules.py.
"""
import argparse
import pathlib
import re
import statistics
import subprocess
import sys

sys.dont_write_bytecode = True  # the tree stays as it is
import source_rules  # noqa: E402

TREE = pathlib.Path(__file__).resolve().parent.parent
LAYERS = ("atmosphere", "lut", "renderer", "viewer")
SOURCES = (".h", ".cpp", ".glsl")
MOST_PUBLIC_METHODS = 20
LIMITS = {
    "types with more than 20 public methods": 0,
    "comment blocks that start without a subject, %": 0.1,
}
# The viewer is for windows and the GPU. A pair of header and source belongs there if one of them names OpenGL, ImGui
# or GLFW, or includes a header of viewer/gl/; these folders are the user's side of the window.
OPEN_GL = re.compile(r'#include "viewer/gl/|\bgl[A-Z]\w*\(|\bGL_[A-Z]|\bGL[a-z]+\b|ImGui|\bIm[A-Z]\w+|GLFW|glfw')
USER_SIDE = ("flight", "input", "hud")
TYPE = re.compile(r"\b(?:class|struct|union|enum|enum class)\s+\w[\w:]*(?:\s+final)?(?:\s*:[^;{()]*)?\s*\{")
FOG_FOLDER = "renderer/media/"
# A sentence whose first word points at something that the reader must guess.
FRAGMENT = re.compile(r"(Of|What|Which|Whose|Whether|Where|How|That|The same|As|Its|Those|Not|Nothing|Only) ")


def files(folder, suffixes=SOURCES):
    return sorted(file for file in (TREE / folder).rglob("*") if file.suffix in suffixes)


def text_of(file):
    return file.read_text(encoding="utf-8")


def line_count(paths):
    return sum(text_of(file).count("\n") for file in paths)


def without_comments(text):
    text = re.sub(r"//[^\n]*", "", text)
    return re.sub(r'"(?:\\.|[^"\\\n])*"', '""', text)


def body_from(text, opening):
    """The text between the brace at `opening` and its partner."""
    depth = 0
    for at in range(opening, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return text[opening + 1:at]
    return text[opening + 1:]


def flat(body):
    """The declarations of a class without the bodies in them."""
    out, depth = [], 0
    for letter in body:
        if letter == "}":
            depth -= 1
            out.append(";" if depth == 0 else "")
        if depth == 0 and letter not in "{}":
            out.append(letter)
        if letter == "{":
            depth += 1
    return "".join(out)


def public_methods(kind, body):
    """How many functions a class declares as public; constructors and operators do not count."""
    count, is_public = 0, kind == "struct"
    for part in re.split(r"\b(public|protected|private)\s*:", flat(body)):
        if part in ("public", "protected", "private"):
            is_public = part == "public"
        elif is_public:
            for statement in part.split(";"):
                name = re.search(r"(\w+)\s*\(", re.sub(r"\[\[.*?\]\]", "", statement))
                has_result = name and re.search(r"[\w>&*]\s+[&*]*$", statement[:statement.find(name[1] + "(")])
                if has_result and "=" not in statement[:name.start()] and "operator" not in statement:
                    count += 1
    return count


def types_of(text):
    text = without_comments(text)
    for found in re.finditer(r"\b(class|struct) (\w+)(?: final)?(?:\s*:[^;{]*)?\s*\{", text):
        yield found[1], found[2], body_from(text, found.end() - 1)


def large_types():
    found = {}
    for layer in LAYERS:
        for file in files(layer, (".h",)):
            for kind, name, body in types_of(text_of(file)):
                methods = public_methods(kind, body)
                if methods > MOST_PUBLIC_METHODS:
                    found[name] = methods
    return found


def lines_without_open_gl():
    """The lines of the viewer that could run without a window: they belong in a lower layer."""
    pairs = {}
    for file in files("viewer", (".h", ".cpp")):
        if file.relative_to(TREE / "viewer").parts[0] not in USER_SIDE:
            pairs.setdefault(file.with_suffix(""), []).append(text_of(file))
    texts = ["".join(pair) for pair in pairs.values()]
    return sum(text.count("\n") for text in texts if not OPEN_GL.search(re.sub(r"//[^\n]*", "", text)))


def comment_blocks():
    """The first line of every block of comments in the layers and the tests, without its slashes."""
    for folder in (*LAYERS, "tests"):
        for file in files(folder):
            before = ""
            for line in text_of(file).splitlines():
                now = line.strip()
                if now.startswith("//") and not before.startswith("//") and "SPDX" not in now:
                    yield now.lstrip("/ <")
                before = now


def types_in(suffix):
    """How many classes, structs, unions and enumerations the layers define, also within others."""
    return sum(len(TYPE.findall(without_comments(text_of(file)))) for layer in LAYERS for file in files(layer, (suffix,)))


def reopened_namespaces():
    """How often a file opens an unnamed namespace that it has had before."""
    return sum(max(len(re.findall(r"^namespace \{", text_of(file), re.MULTILINE)) - 1, 0)
               for layer in LAYERS for file in files(layer))


def missing_shaders():
    """The shaders that a source names and that are not in the tree."""
    missing = (fault.split(": ")[1].split()[0] for fault in source_rules.named_paths_that_are_missing())
    return {name.rpartition("/")[2] for name in missing if name.endswith(".glsl")}


def files_that_name_fog():
    """The files outside the folder of media that name fog."""
    return [file for layer in LAYERS for file in files(layer)
            if not str(file.relative_to(TREE)).startswith(FOG_FOLDER) and re.search("fog", text_of(file), re.IGNORECASE)]


def build_size(build):
    commands = subprocess.run(["ninja", "-C", build, "-t", "commands"], capture_output=True, text=True, check=True)
    lines = commands.stdout.splitlines()
    return {"translation units": sum(" -c " in line for line in lines), "build edges": len(lines)}


def rows(build):
    shape = {}
    for layer in LAYERS:
        lengths = [text_of(file).count("\n") for file in files(layer)]
        shape[f"{layer}: files / lines / median"] = (len(lengths), sum(lengths), statistics.median(lengths))
    code = [file for layer in LAYERS for file in files(layer)]
    shape["source files of the four layers"] = len(code)
    shape["lines of the four layers"] = line_count(code)
    shape["lines of the viewer without OpenGL"] = lines_without_open_gl()
    shape["lines of tests"] = line_count(files("tests"))
    shape["files over 500 lines"] = sum(text_of(file).count("\n") > 500 for file in code)
    large = large_types()
    shape["types with more than 20 public methods"] = len(large)
    shape["the largest of them"] = ", ".join(f"{name} {count}" for name, count in
                                             sorted(large.items(), key=lambda item: -item[1])[:5])
    blocks = list(comment_blocks())
    fragments = sum(bool(FRAGMENT.match(block)) for block in blocks)
    shape["comment blocks"] = len(blocks)
    shape["comment blocks that start without a subject, %"] = round(100.0 * fragments / len(blocks), 1)
    shape["types in headers / in sources"] = (types_in(".h"), types_in(".cpp"))
    shape["unnamed namespaces opened again in one file"] = reopened_namespaces()
    shape["shaders that are named and missing"] = len(missing_shaders())
    shape[f"files outside {FOG_FOLDER} that name fog"] = len(files_that_name_fog())
    shape["installed headers"] = len(files("include"))
    if build:
        shape.update(build_size(build))
    return shape


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", help="build folder of Ninja")
    shape = rows(parser.parse_args().build)
    for name, value in shape.items():
        print(f"{name}: {value}")
    worse = [f"{name}: {shape[name]}, the limit is {limit}" for name, limit in LIMITS.items() if shape[name] > limit]
    print("\n".join(worse), file=sys.stderr)
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
