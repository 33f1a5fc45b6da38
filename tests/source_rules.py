#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks rules of the sources that no compiler knows.

- Folder order: a file includes nothing of a folder above its own. The four layers stand in the order
  atmosphere, lut, renderer, viewer; the folders of a layer stand in the order of the table in its README.
- The README of a layer lists every folder of it.
- Studies: the folders report/ measure the libraries and are not installed with them. Only programs (the sources above
  the folders of a layer), tests and these folders include their headers.
- Namespaces: a source of a layer declares nothing in the namespace of another one. Only the public headers and
  the folders api/, which implement them, declare names in namespace alpenglow.
- Public headers include the standard library and each other, as <alpenglow/NAME.h>, and nothing else.
- The top level of the repository has only the known entries.
- Every file that begins with an interpreter can be run.
- No source includes a header twice.
- Every source of a layer has a header of its name, and includes it first. The headers of the folders api/ are the
  public ones. A program (a source with main) has none.
- Every path of a file named in a source or a build file exists: in the tree, or from the end of a path ("mesh.h").
  A * stands for several names. documents.py checks the Markdown files.
- Every function of a text of SharedTexts (viewer/gl/shader.cpp) has a case in tests/fixtures/shared_text_cases.cpp,
  which also takes the formulas of atmosphere/medium/phase_forms.cpp, or a function that calls it has one.
- Programs write to standard output and error only through lut/cli/messages.h: fmt::print throws
  where standard error takes nothing, which would end the work.
- Nothing reads or writes numbers, or changes the case of letters, by the locale of the host program: it may write
  "0,5" for 0.5 and group thousands. fmt::format, ParseNumber, ParseWholeNumber, LowerCase and UpperCase have no locale.

Every rule is also run on small examples that break it, so that a rule that finds nothing is noticed.
"""
import fnmatch
import os
import pathlib
import re
import sys

TREE = pathlib.Path(__file__).resolve().parent.parent
LAYERS = ("atmosphere", "lut", "renderer", "viewer")
ALL_LAYERS = (*LAYERS, "tests")  # nothing includes what the tests have
# Written by the build, or without contents of a folder: these stand under all folders of their layer.
LOWEST = ("embedded_text.h", "version.h", "layer.h")
TOP_LEVEL = {"CHANGELOG.md", "CITATION.cff", "CMakeLists.txt", "CMakePresets.json", "CONTRIBUTING.md", "LICENSE",
             "README.md", "atmosphere", "build", "include", "lut", "out", "quickstart.sh", "renderer", "tests", "viewer"}
SPEECH = ("fmt::print", "std::cerr", "std::cout <<", "printf(")
BY_LOCALE = re.compile(
    r"\bstd::to_w?string\(|\b(?:std::)?sto(?:[dfi]|l|ld|ll|ul|ull)\(|\b(?:std::)?strto\w+\(|\b(?:std::)?ato(?:[fil]|ll)\(|"
    r"\b\w*(?:scanf|printf|strftime)\(|\b[io]?stringstream\b|\bstd::(?:setprecision|put_time|get_time|locale)\b|"
    r"\b(?:std::)?(?:is(?:alnum|alpha|digit|lower|print|punct|space|upper)|tolower|toupper)\(|\{[\w.:]*:[^{}]*L\}|"
    r"\b\w*(?:file|stream|text|line|info)\w* >> ")
# A path of a file; and names that stand for any name: NAME_command.h, name_kernel.cpp, a.cpp.
NAMED_FILE = re.compile(r"(?<![\w/.*<>-])((?:[\w*.-]+/)*[A-Za-z\d*][\w*.-]*\.(?:h|cpp|glsl|md|py|cmake))(?![\w/])")
ANY_NAME = re.compile(r"(?:NAME|name|[a-z](?:\.[A-Z])?)(?:_[a-z]+)?\.[a-z]+")
# Headers of other projects, files that the programs write, and names in examples of tests.
FOREIGN_FILES = {"erfa.h", "ImfEnvmap.h", "locale/localeinfo.h", "summary.md", "broken.glsl",
                 "ground.frag.glsl"}
INCLUDE = re.compile(r'^\s*#\s*include\s*["<](?:alpenglow/)?([^">]+)[">]')
CASE = re.compile(r"ALPENGLOW_(?:SHARED_CASE\((.*?)grid::|PHASE_VALUE\((.*?)\),$)", re.DOTALL | re.MULTILINE)
NAMESPACE = re.compile(r"^namespace alpenglow::(\w+)", re.MULTILINE)


def folders_of(readme):
    """The folders of the rows "| `folder/` | ..." of a README, lowest first."""
    return re.findall(r"^\| `(\w+)/` \|", readme, re.MULTILINE)


def place_of(path, order):
    """The ranks of the layer and of the folder of "lut/sky/panorama.h"; None for a file of no layer.
    Files at the top of a layer stand above its folders, a folder that is not listed above those."""
    layer, _, rest = path.partition("/")
    if layer not in ALL_LAYERS or not rest:
        return None
    folder, _, name = rest.rpartition("/")
    folders = order.get(layer, [])
    if name in LOWEST:
        rank = 0
    elif not folder:
        rank = len(folders)
    else:
        rank = folders.index(folder) if folder in folders else len(folders) + 1
    return ALL_LAYERS.index(layer), rank


def includes_upwards(path, text, order):
    here = place_of(path, order)
    for number, line in enumerate(text.splitlines(), 1):
        found = INCLUDE.match(line)
        there = place_of(found[1], order) if found else None
        if there and (there[0] > here[0] or there[0] == here[0] and there[1] > here[1]):
            yield f"{path}:{number}: {found[1]} stands above this file"


def includes_of_studies(path, text):
    """The headers of the folders report/ that a source of an installed library includes."""
    folder = path.split("/")[1:-1]
    if not folder or folder == ["report"]:
        return
    for included in re.findall(r'^#include "(\w+/report/[^"]+)"', text, re.MULTILINE):
        yield f"{path}: {included} is not installed"


def foreign_namespaces(path, text):
    layer = path.partition("/")[0]
    for name in NAMESPACE.findall(text):
        if name in LAYERS and name != layer and not path.endswith("/layer.h"):
            yield f"{path}: namespace alpenglow::{name} belongs to another layer"
    is_public = path.startswith("include/") or path.split("/")[1:2] == ["api"]
    if not is_public and re.search(r"^namespace alpenglow \{", text, re.MULTILINE):
        yield f"{path}: namespace alpenglow without the name of a layer"


def foreign_includes(path, text):
    """What a public header includes that strangers do not have."""
    for included in re.findall(r"^\s*#\s*include\s*(\S+)", text, re.MULTILINE):
        if not re.fullmatch(r"<(alpenglow/\w+\.h|\w+)>", included):
            yield f"{path}: a public header includes {included}"


def repeated_includes(path, text):
    """The headers that a source includes again."""
    included = re.findall(r'^#include ["<](.*)[">]', text, flags=re.MULTILINE)
    for again in sorted({header for header in included if included.count(header) > 1}):
        yield f"{path}: {again} is included twice"


def first_include(path, text, files):
    """The fault of a source whose first include is not the header of its name."""
    name = path.removesuffix(".cpp")
    header = f"{name}.h"
    if path.split("/")[1:2] == ["api"] and header not in files:
        header = f"alpenglow/{name.rpartition('/')[2]}.h"
    first = re.search(r'^#include ["<](.*)[">]', text, flags=re.MULTILINE)
    is_program = re.search(r"^int main\(", text, re.MULTILINE)
    if not is_program and (not first or first[1] != header):
        yield f"{path}: the first include is not {header}"


def missing_files(path, text, ends):
    """The files that a source names and that are not in the tree.
    @param ends  the paths of all files, and all ends of them."""
    for number, line in enumerate(text.splitlines(), 1):
        if INCLUDE.match(line):
            continue  # the compiler checks these
        for named in NAMED_FILE.findall(line.replace("\\n", " ").replace("../", "")):
            name = named.rpartition("/")[2]
            exists = named in ends or "*" in named and any(fnmatch.fnmatchcase(end, named) for end in ends)
            if not exists and not ANY_NAME.fullmatch(name) and {name, named}.isdisjoint({*FOREIGN_FILES, *LOWEST}):
                yield f"{path}:{number}: {named} does not exist"


def ends_of(paths):
    """The paths and all ends of them: "a/b.h" and "b.h"."""
    return {path.split("/", skipped)[-1] for path in paths for skipped in range(path.count("/") + 1)}


def speech(path, text):
    return [f"{path}: {words} does not go through lut/cli/messages.h" for words in SPEECH if words in text]


def by_locale(path, text):
    """The calls that depend on the locale, outside comments."""
    for number, line in enumerate(text.splitlines(), 1):
        found = BY_LOCALE.search(line.partition("//")[0])
        if found:
            yield f"{path}:{number}: {found[0]} depends on the locale of the host program; use atmosphere/base/parsing.h"


def functions_without_case(shared, cases):
    """The functions of shared texts that no case calls, neither itself nor by another function."""
    called_by = {}
    for text in shared:
        for function in re.split(r"^SHARED\s+\w+\s+", re.sub(r"//.*", "", text), flags=re.MULTILINE)[1:]:
            name, _, rest = function.partition("(")
            called_by[name] = set(re.findall(r"\b(\w+)\(", rest))
    reached = set()
    new = {name for case in CASE.findall(cases) for name in re.findall(r"\b(\w+)\(", "".join(case))}
    while new:
        reached |= new
        new = {name for caller in new for name in called_by.get(caller, ())} - reached
    return sorted(set(called_by) - reached)


def check_examples():
    """Every rule finds what breaks it, and nothing else."""
    order = {"atmosphere": ["base", "medium"], "lut": ["image", "sky"], "renderer": ["terrain"], "viewer": []}
    for path, included, expected in (
            ("lut/sky/panorama.h", "renderer/terrain/mesh.h", 1),  # a higher layer
            ("lut/image/image.h", "lut/sky/panorama.h", 1),  # a higher folder
            ("lut/image/image.h", "lut/sky_command.h", 1),  # the top
            ("lut/image/image.h", "lut/cellar/wine.h", 1),  # a folder that is not listed
            ("lut/image/image.h", "tests/fixtures/stored_cases.h", 1),
            ("lut/image/image.h", "alpenglow/renderer/terrain/mesh.h", 1),
            ("lut/sky/panorama.h", "lut/image/image.h", 0),
            ("lut/sky/panorama.h", "lut/embedded_text.h", 0),
            ("lut/image/image.h", "lut/layer.h", 0),
            ("lut/sky_command.cpp", "lut/sky/panorama.h", 0),
            ("lut/image/image.h", "atmosphere/medium/medium.h", 0)):
        found = list(includes_upwards(path, f'#include <vector>\n#include "{included}"\n', order))
        assert len(found) == expected, (path, included, found)
    study = '#include "lut/report/report.h"\n'
    assert len(list(includes_of_studies("renderer/series/a.cpp", study))) == 1
    assert not list(includes_of_studies("renderer/report/a.h", study))
    assert not list(includes_of_studies("lut/table_commands.cpp", study))
    assert len(list(foreign_namespaces("lut/sky/a.h", "namespace alpenglow::renderer {\n"))) == 1
    assert len(list(foreign_namespaces("lut/sky/a.h", "namespace alpenglow {\n"))) == 1
    assert not list(foreign_namespaces("lut/api/a.h", "namespace alpenglow {\n"))
    assert len(list(foreign_includes("a.h", '#include "b.h"\n#include <glm/vec3.hpp>\n'))) == 2
    assert not list(foreign_includes("a.h", "#include <vector>\n#include <alpenglow/b.h>\n"))
    assert not list(foreign_namespaces("lut/sky/a.h", "namespace alpenglow::lut {\nnamespace alpenglow::shared {\n"))
    assert len(speech("lut/a.cpp", 'std::cerr << "x";')) == 1
    for call in ("std::to_string(x)", "std::stod(t)", "stoul(t)", "std::strtod(t, nullptr)", "strtof(t, &e)", "atof(t)",
                 "sscanf(t, f, &x)", "std::snprintf(b, 9, f, x)", "std::istringstream s(t)", "std::tolower(c)",
                 "isspace(c)", "out << std::setprecision(3)", 'fmt::format("{:L}", x)', "file >> x"):
        assert len(list(by_locale("a.cpp", f"  {call};\n"))) == 1, call
    assert not list(by_locale("a.cpp", 'fmt::format("{:.3f}", LowerCase(x));  // not std::stod(x)\ncustom(restore(x));\n'))
    assert list(repeated_includes("a.cpp", '#include <a>\n#include "b.h"\n#include "b.h"\n')) == [
        "a.cpp: b.h is included twice"]
    for path, text, expected in (
            ("lut/a.cpp", '#include "lut/a.h"\n#include "lut/b.h"\n', 0),
            ("lut/a.cpp", '#include "lut/b.h"\n#include "lut/a.h"\n', 1),
            ("lut/a.cpp", "int b() { return 0; }\n", 1),
            ("lut/a.cpp", "#include <vector>\nint main() { return 0; }\n", 0),
            ("lut/api/a.cpp", "#include <alpenglow/a.h>\n", 0),
            ("lut/api/a.cpp", "#include <alpenglow/b.h>\n", 1),
            ("lut/api/own.cpp", "#include <alpenglow/own.h>\n", 1)):
        found = list(first_include(path, text, {"lut/api/own.h"}))
        assert len(found) == expected, (path, text, found)
    ends = ends_of(["lut/sky/panorama.h", "viewer/shaders/land/land.frag.glsl"])
    for text, expected in (("// See panorama.h, sky/panorama.h and lut/sky/panorama.h.", 0), ("// lut/panorama.h", 1),
                           ('Compile("viewer/shaders/land/land.frag.glsl");', 0), ('"shaders/land/land.vert.glsl"', 1),
                           ("// sky/*.h or shaders/*.vert.glsl", 1), ("// NAME_command.h, a.cpp", 0),
                           ('#include <ImfArray.h>', 0), ("// written by picture_list.py", 1)):
        found = list(missing_files("a.h", text, ends))
        assert len(found) == expected, (text, found)
    shared = "SHARED Number A(Number x) {\n  return B(x);  // C(x)\n}\nSHARED Number B(Number x) { return x; }\n"
    assert functions_without_case([shared, "SHARED Number C(Number x) { return x; }\n"],
                                  "ALPENGLOW_SHARED_CASE(A(a[0]), grid::Rays())\nC(1.0)\n") == ["C"]
    assert not functions_without_case([shared], "     ALPENGLOW_PHASE_VALUE(A(c, p.x)),\n     .mean = nullptr},\n")
    assert folders_of("| `air/` | media |\n| `ray.h` | no folder |\n") == ["air"]


def sources(layer):
    files = [file for file in sorted((TREE / layer).rglob("*")) if file.suffix in (".h", ".cpp", ".glsl")]
    assert len(files) > 50, f"{layer}: the rules must have looked at the sources"
    return [(str(file.relative_to(TREE)), file.read_text(encoding="utf-8")) for file in files]


def named_paths_that_are_missing():
    files = [file for file in files_of_the_repository() if "__pycache__" not in file.parts]
    ends = ends_of(str(file.relative_to(TREE)) for file in files)
    for file in files:
        is_source = file.suffix in (".h", ".cpp", ".glsl", ".cmake") or file.name == "CMakeLists.txt"
        if is_source:
            yield from missing_files(str(file.relative_to(TREE)), file.read_text(encoding="utf-8"), ends)


def broken_rules():
    order = {layer: folders_of((TREE / layer / "README.md").read_text(encoding="utf-8")) for layer in LAYERS}
    for layer in LAYERS:
        found = {entry.name for entry in (TREE / layer).iterdir() if entry.is_dir() and entry.name != "data"}
        for folder in sorted(found ^ set(order[layer])):
            yield f"{layer}/README.md: {folder}/ is listed or there, not both"
        files = {path for path, _ in sources(layer)}
        for path, text in sources(layer):
            yield from includes_upwards(path, text, order)
            yield from includes_of_studies(path, text)
            if path.endswith(".cpp"):
                yield from first_include(path, text, files)
            if not path.endswith(".glsl"):
                yield from foreign_namespaces(path, text)
                yield from speech(path, text)
                yield from by_locale(path, text)
    for file in sorted((TREE / "include").rglob("*.h")):
        yield from foreign_includes(str(file.relative_to(TREE)), file.read_text(encoding="utf-8"))
    shared = re.findall(r'"([\w/]+\.glsl)"', (TREE / "viewer/gl/shader.cpp").read_text(encoding="utf-8"))
    cases = "".join((TREE / path).read_text(encoding="utf-8")
                    for path in ("tests/fixtures/shared_text_cases.cpp", "atmosphere/medium/phase_forms.cpp"))
    assert len(shared) > 10, "the rule must have looked at the shared texts"
    for name in functions_without_case([(TREE / path).read_text(encoding="utf-8") for path in shared], cases):
        yield f"tests/fixtures/shared_text_cases.cpp: {name} of a shared text has no case"
    yield from named_paths_that_are_missing()
    for entry in sorted(TREE.iterdir()):
        if entry.name[0] != "." and entry.name not in TOP_LEVEL:
            yield f"{entry.name}: the top level is closed"
    for file in files_of_the_repository():
        if file.suffix in (".h", ".cpp"):
            yield from repeated_includes(str(file.relative_to(TREE)), file.read_text(encoding="utf-8"))
    scripts = [file for file in files_of_the_repository() if file.open("rb").read(2) == b"#!"]
    assert len(scripts) > 3, "the rule must have looked at the scripts"
    for file in scripts:
        if not os.access(file, os.X_OK):
            yield f"{file.relative_to(TREE)}: begins with an interpreter and cannot be run"


def files_of_the_repository():
    for entry in sorted(TREE.iterdir()):
        if entry.name not in ("build", "out", ".git"):
            yield from (file for file in ([entry] if entry.is_file() else sorted(entry.rglob("*")))
                        if file.is_file())


def main():
    check_examples()
    broken = list(broken_rules())
    print("\n".join(broken) if broken else "the sources keep every rule")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
