"""The rules of docs/develop/architecture.md that a compiler does not check: permitted includes, contents of headers, and wording of
the library's messages."""

import re
from pathlib import Path

# A folder of src/interflect uses only those before it; the programs in apps/ use FOR_PROGRAMS.
LAYERS = [
    "base", "scene", "geometry", "image", "generators", "formats", "raycast", "luminaires", "checks", "view_factors",
    "elements", "solver", "render", "audit", "rates", "photometry", "metrics", "exports", "cluster",
]

# Their own folders, in the same order; files beside these come last.
INNER_LAYERS = {
    "base": ["memory", "files", "threads", "numbers", "sums", "."],
    "scene": ["faces", "core", "luminaires", "sky", "."],
    "geometry": ["polygons", "search", "textures", "surfaces", "coverage", "contacts", "."],
    "image": ["codecs", "files", "tone", "plots", "."],
    "generators": ["building", "building/plan", "building/walls", "building/rooms", "."],
    "formats": [
        "text", "reading", "shapes", "build", "photometry", "gltf/data", "gltf/parts", "gltf", "mgf/context", "mgf",
        "rad/statements", "rad", "mesh", "mesh/obj", "mesh/ply", ".",
    ],
    "raycast": ["embree", "."],
    "luminaires": ["skies", "."],
    "checks": ["search", "faces", "lights", "views", "."],
    "view_factors": ["exchange", "rays", "."],
    "elements": ["."],
    "solver": [
        "light", "clusters", "importance", "sampling", "noise", "deposit", "transport", "state", "shrinkage", "error",
        "refinement", "iteration", "methods", "methods/baselines", "methods/links", "methods/particles", ".",
    ],
    "render": ["smooth", "lights", "reflections", "rays", "direct", "paths", "prepared", "sharing", "pictures", "gauges", "filters", "preview", "."],
    "audit": ["."],
    "rates": ["."],
    "photometry": ["."],
    "metrics": ["."],
    "exports": ["hdf5", "records", "mesh", "charts", "lightmap", "vertices", "files", "gltf", "authored", "foreign", "."],
    "cluster": ["."],
}
# Headers of src/interflect that programs in apps/ may include: services of a program, records of files and processes.
# Estimators, geometry, the state of the solver and light sources are behind public headers.
FOR_PROGRAMS = [
    "base/files/escapes.h", "base/files/input_file.h", "base/files/pending_file.h", "base/memory/machine_memory.h",
    "cluster/fingerprint.h", "exports/records/json_text.h", "exports/records/solve_report.h", "exports/saved_run.h",
    "formats/scene_files.h", "image/files/pending_image.h", "render/shared_light.h", "view_factors/write_npz.h",
]
# A folder has at most so many files, but for these: the public headers are one list, and data are not read one by one.
MOST_FILES = 12
PARTS = [
    "apps", "bench", "docs", "examples", "experiments", "include", "integrations", "packaging", "python", "scripts", "src", "tests",
]
WRITTEN = {"node_modules", "__pycache__"}  # by programs
UNLIMITED = ["include/interflect", "tests/fuzz/seeds", "experiments/results", "docs/figures", "docs/pictures"]

PRIVATE_INCLUDE = re.compile(r'^\s*#\s*include\s*"interflect/(\w+/[^"]+)"', re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*"interflect/(\w+)/', re.MULTILINE)
USING_NAMESPACE = re.compile(r"^\s*using\s+namespace\b", re.MULTILINE)
PRAGMA_ONCE = re.compile(r"^#pragma once$", re.MULTILINE)
NAMESPACE = re.compile(r"^namespace interflect\b(?!::detail\b).*", re.MULTILINE)
DETAIL = re.compile(r"^namespace (?:interflect::)?detail \{\n(.*?)^\}", re.MULTILINE | re.DOTALL)
FORWARD_DECLARATION = re.compile(r"(class|struct) \w+;")
LITERAL = re.compile(r"""'\\?.'|"(?:[^"\\\n]|\\.)*\"""")
TYPE = re.compile(r"^(?:class|struct) (\w+)(?: final)?(?: :[^;{]*)?\s*\{", re.MULTILINE)
OPTION = re.compile(r"--[a-z]")
USES = re.compile(r"\bUSES\s+([a-z_ \n]+)")


def faults(root: Path) -> list[str]:
    """Returns every violation below `root`, the repository's folder, as 'file: problem'; empty if all rules hold."""
    library = root / "src" / "interflect"
    folders = sorted(path for path in library.iterdir() if path.is_dir())
    found = [f"{folder}: not one of the layers {' '.join(LAYERS)}" for folder in folders if folder.name not in LAYERS]
    for folder in folders:
        if folder.name in LAYERS:
            found += layer_faults(folder)
    for name in INNER_LAYERS:
        found += inner_faults(library / name)
    found += size_faults(root)
    found += program_faults(root / "apps")
    public = sorted((root / "include").rglob("*.h"))
    for header in public:
        found += [f"{header}: includes interflect/{folder}/, which is not installed"
                  for folder in INCLUDE.findall(header.read_text())]
    for header in public:
        found += [f"{header}: '{line}' is internal: expected forward declarations alone"
                  for block in DETAIL.findall(header.read_text())
                  for line in block.splitlines() if not FORWARD_DECLARATION.fullmatch(line)]
    for header in sorted(library.rglob("*.h")):
        found += [f"{header}: '{line}' is for public headers: expected 'namespace interflect::detail'"
                  for line in NAMESPACE.findall(header.read_text())]
    found += repeated_types([*public, *library.rglob("*.h")])
    for source in sorted([*public, *library.rglob("*.h"), *library.rglob("*.cpp")]):
        found += [f"{source}: {literal} names an option of the command line, which other programs do not have"
                  for literal in LITERAL.findall(source.read_text()) if OPTION.search(literal)]
    for header in sorted([*public, *library.rglob("*.h"), *(root / "apps").rglob("*.h")]):
        found += header_faults(header)
    return found


def program_faults(apps: Path) -> list[str]:
    """Finds includes of programs that are neither public nor in FOR_PROGRAMS."""
    return [f"{source}: includes interflect/{header}, which is not for programs: expected a public header"
            for source in sorted([*apps.rglob("*.h"), *apps.rglob("*.cpp")])
            for header in PRIVATE_INCLUDE.findall(source.read_text()) if header not in FOR_PROGRAMS]


def layer_faults(folder: Path) -> list[str]:
    """Finds includes from other layers than those under USES in CMakeLists.txt, which must come earlier in LAYERS."""
    found = []
    earlier = LAYERS[: LAYERS.index(folder.name)]
    build_file = folder / "CMakeLists.txt"
    uses = declared_uses(build_file)
    found += [f"{build_file}: {folder.name} USES {used}, which is not before it" for used in uses if used not in earlier]
    for source in sorted([*folder.rglob("*.h"), *folder.rglob("*.cpp")]):
        for included in INCLUDE.findall(source.read_text()):
            if included not in [folder.name, *uses]:
                found.append(f"{source}: includes interflect/{included}/, which {build_file} does not name under USES")
    return found


def inner_faults(outer: Path) -> list[str]:
    """Finds includes of a layer from its later folders."""
    found = []
    layers = INNER_LAYERS[outer.name]
    include = re.compile(rf'^\s*#\s*include\s*"interflect/{outer.name}/([^"]+)"', re.MULTILINE)
    for folder in sorted(path for path in (outer, *outer.rglob("*")) if path.is_dir()):
        name = folder.relative_to(outer).as_posix()
        files = [path for path in folder.iterdir() if path.is_file()]
        if name not in layers:
            found.append(f"{folder}: not one of the folders of {outer.name}, {' '.join(layers)}")
            continue
        for source in sorted(path for path in files if path.suffix in (".h", ".cpp")):
            for included in include.findall(source.read_text()):
                layer = Path(included).parent.as_posix()
                if layer not in layers or layers.index(layer) > layers.index(name):
                    found.append(f"{source}: includes {included}, which is not before {outer.name}/{name}")
    return found


def size_faults(root: Path) -> list[str]:
    """Finds folders of sources, tests and pages with too many files."""
    found = []
    exempt = {root / folder for folder in UNLIMITED}
    for top in PARTS:
        for folder in (root / top, *sorted((root / top).rglob("*"))):
            if not folder.is_dir() or folder in exempt or not WRITTEN.isdisjoint(folder.relative_to(root).parts):
                continue
            count = sum(path.is_file() and not path.name.startswith(".") for path in folder.iterdir())
            if count > MOST_FILES:
                found.append(f"{folder}: {count} files, expected at most {MOST_FILES}")
    return found


def declared_uses(build_file: Path) -> list[str]:
    match = USES.search(build_file.read_text())
    return match.group(1).split() if match else []


def repeated_types(headers: list[Path]) -> list[str]:
    """Finds types of one name in two headers. Their functions would have one name, too, and the linker would keep one."""
    found, first = [], {}
    for header in sorted(headers):
        for name in TYPE.findall(header.read_text()):
            if first.setdefault(name, header) != header:
                found.append(f"{header}: another type is called {name} in {first[name]}")
    return found


def header_faults(header: Path) -> list[str]:
    text = header.read_text()
    found = []
    if not PRAGMA_ONCE.search(text):
        found.append(f"{header}: no '#pragma once'")
    if USING_NAMESPACE.search(text):
        found.append(f"{header}: 'using namespace' in a header")
    return found
