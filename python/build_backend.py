"""Makes the wheel for `pip install .` with CMake: the hooks of PEP 517, from Python's own library.

The folder of the build is build/python, and is kept. With INTERFLECT_BUILD_FOLDER in the environment, the module of another
build of this source is packed, for example build/release.
"""

from __future__ import annotations

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
VERSION = re.search(r"project\(interflect VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
NAME = f"interflect-{VERSION}"


def build_wheel(wheel_directory: str, config_settings: dict | None = None, metadata_directory: str | None = None) -> str:
    """Compiles the module and writes the wheel; returns its name."""
    return _write_wheel(Path(wheel_directory), _files(_build()))


def build_editable(wheel_directory: str, config_settings: dict | None = None,
                   metadata_directory: str | None = None) -> str:
    """The same, for a package that stays in the folder of the build: only a path is installed."""
    return _write_wheel(Path(wheel_directory), {"interflect.pth": f"{_build() / 'python'}\n".encode()})


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: dict | None = None) -> str:
    """Writes the metadata alone, without compiling."""
    folder = Path(metadata_directory) / f"{NAME}.dist-info"
    folder.mkdir()
    for name, content in _metadata().items():
        (folder / Path(name).name).write_bytes(content)
    return folder.name


prepare_metadata_for_build_editable = prepare_metadata_for_build_wheel


def build_sdist(sdist_directory: str, config_settings: dict | None = None) -> str:
    """Archives the files that git tracks."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    with tarfile.open(Path(sdist_directory) / f"{NAME}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for name in filter(None, listed.split("\0")):
            archive.add(ROOT / name, f"{NAME}/{name}", recursive=False)
    return f"{NAME}.tar.gz"


def _build() -> Path:
    """Compiles the module for this Python; returns the folder of the build."""
    given = os.environ.get("INTERFLECT_BUILD_FOLDER")
    folder = Path(given or ROOT / "build" / "python").resolve()
    if not given:
        _run("cmake", "--preset", "python", f"-DPython3_EXECUTABLE={sys.executable}")
    _run("cmake", "--build", str(folder), "--parallel", str(os.cpu_count()), "--target", "interflect_python_package")
    return folder


def _run(*command: str) -> None:
    try:
        subprocess.run(command, cwd=ROOT, check=True)
    except FileNotFoundError:
        sys.exit(f"{command[0]} is missing: scripts/setup python installs what the build needs")
    except subprocess.CalledProcessError:
        sys.exit("the build failed; scripts/setup python installs the Debian packages that it needs")


def _files(folder: Path) -> dict[str, bytes]:
    package = folder / "python" / "interflect"
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    names = ["*.py", "*.pyi", "py.typed", f"_core{suffix}"]
    files = {f"interflect/{path.name}": path.read_bytes() for name in names for path in sorted(package.glob(name))}
    if f"interflect/_core{suffix}" not in files:
        sys.exit(f"{folder} has no module for this Python, {sys.executable} ({suffix})")
    return files


def _metadata() -> dict[str, bytes]:
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    extras = PROJECT["optional-dependencies"]
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {PROJECT['name']}",
        f"Version: {VERSION}",
        f"Summary: {PROJECT['description']}",
        "License: Apache-2.0",
        f"Keywords: {','.join(PROJECT['keywords'])}",
        *(f"Classifier: {classifier}" for classifier in PROJECT["classifiers"]),
        f"Requires-Python: {PROJECT['requires-python']}",
        *(f"Requires-Dist: {requirement}" for requirement in PROJECT["dependencies"]),
        *(f"Provides-Extra: {extra}" for extra in extras),
        *(f"Requires-Dist: {name}; extra == '{extra}'" for extra, names in extras.items() for name in names),
        "Description-Content-Type: text/markdown",
        "",
        (ROOT / "README.md").read_text(encoding="utf-8"),
    ]
    wheel = f"Wheel-Version: 1.0\nGenerator: interflect\nRoot-Is-Purelib: false\nTag: {tag}-{tag}-{platform}\n"
    folder = f"{NAME}.dist-info"
    return {
        f"{folder}/METADATA": "\n".join(lines).encode(),
        f"{folder}/WHEEL": wheel.encode(),
        f"{folder}/LICENSE": (ROOT / "LICENSE").read_bytes(),
    }


def _write_wheel(directory: Path, files: dict[str, bytes]) -> str:
    """Writes a wheel; equal files give equal bytes."""
    files |= _metadata()
    record = f"{NAME}.dist-info/RECORD"
    rows = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        rows.append(f"{name},sha256={digest},{len(content)}\n")
    files[record] = "".join([*rows, f"{record},,\n"]).encode()
    tag = re.search(rb"^Tag: (.*)$", files[f"{NAME}.dist-info/WHEEL"], re.MULTILINE)[1].decode()
    wheel = f"{NAME}-{tag}.whl"
    with zipfile.ZipFile(directory / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
    return wheel
