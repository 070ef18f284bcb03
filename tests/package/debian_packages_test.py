"""The Debian packages that cpack makes of the built tree: their files, their documents compared with the help texts, their
licences, and the same bytes a second time."""

import gzip
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMAND = Path(os.environ["INTERFLECT_COMMAND"])
BUILD = COMMAND.parents[1]
CACHE = (BUILD / "CMakeCache.txt").read_text()
DATE = "1700000000"  # [s]: 14 November 2023, 22:13:20

OPTION = re.compile(r"^  (-\S+)", re.MULTILINE)  # names as in the help: '-o,--output' or '--clusters,--no-clusters{false}'
SYSTEM_LIBRARIES = {"libc6", "libgcc-s1", "libstdc++6", "libopenmpi3"}  # under their own licences, or only in builds with MPI


def run(*command, **options) -> str:
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True, **options)
    if result.returncode:
        raise AssertionError(f"{command} ended with {result.returncode}:\n{result.stdout}{result.stderr}")
    return result.stdout


def make_packages(folder: Path) -> dict[str, Path]:
    """Returns the files by the name of the package. They are compressed by gzip, which is several times faster than xz."""
    run("cpack", "--config", BUILD / "CPackConfig.cmake", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip", "-B", folder,
        env=os.environ | {"SOURCE_DATE_EPOCH": DATE})
    return {path.name.partition("_")[0]: path for path in folder.glob("*.deb")}


def help_of(*subcommands: str) -> str:
    text = run(COMMAND, *subcommands, "--help")
    return text if "\nSubcommands:\n" in text else run(COMMAND, *subcommands, "--help-all")


def all_subcommands(*above: str) -> list[tuple[str, ...]]:
    """Returns the words after `interflect` of every subcommand, such as ('make-scene', 'maze')."""
    _, _, below = help_of(*above).partition("\nSubcommands:\n")
    found = [(*above, name) for name in re.findall(r"^  (\S+)", below, re.MULTILINE)]
    return [words for name in found for words in (name, *all_subcommands(*name))]


def options_in(text: str) -> set[str]:
    return {re.sub(r"\{.*", "", name) for names in OPTION.findall(text) for name in names.split(",")}


class DebianPackages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.packages = make_packages(cls.folder / "first")
        cls.unpacked = {}
        for name, path in cls.packages.items():
            cls.unpacked[name] = cls.folder / name
            run("dpkg-deb", "--extract", path, cls.unpacked[name])
        cls.share = cls.unpacked["interflect"] / "usr/share"
        cls.pages = [(), *all_subcommands()]

    def files(self, package: str) -> set[str]:
        root = self.unpacked[package]
        return {path.relative_to(root).as_posix() for path in root.rglob("*") if path.is_file()}

    def field(self, package: str, name: str) -> str:
        return run("dpkg-deb", "--field", self.packages[package], name).strip()

    def test_the_command_runs_and_brings_scenes_and_the_add_on(self):
        self.assertIn("interflect", run(self.unpacked["interflect"] / "usr/bin/interflect", "--version"))
        for source, target in ((ROOT / "scenes", "usr/share/interflect/scenes"),
                               (ROOT / "integrations/blender/interflect", "usr/share/blender/scripts/addons/interflect")):
            expected = {f"{target}/{path.relative_to(source).as_posix()}" for path in source.rglob("*")
                        if path.is_file() and path.parent.name != "__pycache__"}
            self.assertEqual({name for name in self.files("interflect") if name.startswith(target)}, expected)

    def test_headers_and_the_library_are_in_the_other_package(self):
        files = self.files("libinterflect-dev")
        headers = {f"usr/{path.relative_to(ROOT).as_posix()}" for path in (ROOT / "include").rglob("*.h")}
        self.assertEqual({name for name in files if name.startswith("usr/include/")}, headers)
        for ending in ("/libinterflect.a", "/cmake/interflect/interflect-config.cmake"):
            self.assertEqual(len([name for name in files if name.endswith(ending)]), 1, ending)
        self.assertEqual([name for name in self.files("interflect") if re.match("usr/(include|lib)/", name)], [])

    def test_dependencies(self):
        """The command depends on libraries only, the other package on development packages of scripts/setup."""
        depends = self.field("interflect", "Depends")
        self.assertIn("libembree3-3", depends)
        self.assertNotIn("-dev", depends)
        for_building = re.search(r"^libraries=\((.*?)\)", (ROOT / "scripts/setup").read_text(), re.DOTALL | re.MULTILINE)[1]
        for package in self.field("libinterflect-dev", "Depends").split(", "):
            self.assertIn(package, for_building.split())

    def test_the_description_names_the_processors(self):
        processors = re.search(r"^INTERFLECT_ARCH:STRING=(.*)$", CACHE, re.MULTILINE)[1]
        for package in self.packages:
            self.assertIn(processors, self.field(package, "Description"))

    def test_every_subcommand_has_a_man_page_with_all_its_options(self):
        pages = {path.name for path in (self.share / "man/man1").iterdir()}
        self.assertEqual(pages, {"-".join(["interflect", *words]) + ".1.gz" for words in self.pages})
        for words in self.pages:
            path = self.share / "man/man1" / ("-".join(["interflect", *words]) + ".1.gz")
            run("mandoc", "-T", "lint", "-W", "warning", path)
            text = run("mandoc", "-T", "utf8", "-O", "width=200", path)
            text = re.sub(".\b", "", text)  # bold and underlined characters
            shown = {name for line in text.splitlines() for name in re.findall(r"(?<=[ ,])-[-\w]+", line) if line.startswith(" ")}
            self.assertLessEqual(options_in(help_of(*words)), shown, path.name)
            self.assertIn(help_of(*words).split("\n")[0].removeprefix("Interflect: "), " ".join(text.split()))

    def completions_of(self, *words: str) -> set[str]:
        """Returns the proposals of bash for the last of these words."""
        script = """
            source "$0"
            COMP_WORDS=("$@")
            COMP_CWORD=$(($# - 1))
            _interflect 2>/dev/null
            printf '%s\\n' "${COMPREPLY[@]}"
        """
        completion = self.share / "bash-completion/completions/interflect"
        return set(run("bash", "-c", script, completion, "interflect", *words).split())

    def test_completion_proposes_every_subcommand_option_and_word(self):
        for words in self.pages:
            self.assertEqual(self.completions_of(*words, "-"), options_in(help_of(*words)), words)
        self.assertEqual({(word,) for word in self.completions_of("")}, {words for words in self.pages if len(words) == 1})
        self.assertEqual(self.completions_of("make-scene", "m"), {"maze"})
        self.assertEqual(self.completions_of("render", "office.h5", "--shading", "g"), {"gather"})
        self.assertEqual(self.completions_of("solve", "--rays", ""), set())

    def test_other_shells_complete_every_option(self):
        zsh = (self.share / "zsh/vendor-completions/_interflect").read_text()
        fish = (self.share / "fish/vendor_completions.d/interflect.fish").read_text()
        for words in self.pages:
            function = re.search(rf"^{'_'.join(['_interflect', *words]).replace('-', '_')}\(\).*?^}}", zsh, re.DOTALL | re.MULTILINE)[0]
            for name in options_in(help_of(*words)):
                self.assertRegex(function, rf"'\*{name}[=\[]")
                self.assertRegex(fish, rf" -[ls] {name.lstrip('-')} ")

    def test_licences(self):
        """Every licence is printed, and every library linked is named with its own."""
        text = (self.share / "doc/interflect/copyright").read_text()
        other = self.unpacked["libinterflect-dev"] / "usr/share/doc/libinterflect-dev/copyright"
        self.assertEqual(text, other.read_text())
        paragraphs = text.split("\n\n")
        named = set(re.findall(r"^License: (\S+)$", "\n".join(p for p in paragraphs if p.startswith("Files: ")), re.MULTILINE))
        printed = {p.split("\n")[0].removeprefix("License: ") for p in paragraphs if p.startswith("License: ")}
        self.assertEqual(named, printed)
        linked = {re.split(r"[ :]", alternative)[0] for alternative in self.field("interflect", "Depends").split(", ")}
        for package in linked - SYSTEM_LIBRARIES:
            self.assertIn(package.removesuffix("-fmt9"), text)

    def test_no_path_of_this_machine(self):
        """Only a release build leaves out the names of its source files."""
        is_release = "CMAKE_BUILD_TYPE:STRING=Release" in CACHE
        for package, root in self.unpacked.items():
            for name in self.files(package):
                content = (root / name).read_bytes()
                if name.endswith(".gz"):
                    content = gzip.decompress(content)
                if is_release or not name.endswith((".a", "bin/interflect")):
                    for path in (ROOT, BUILD):
                        self.assertNotIn(str(path).encode(), content, name)

    def test_the_same_bytes_a_second_time(self):
        again = make_packages(self.folder / "again")
        self.assertEqual(set(again), {"interflect", "libinterflect-dev"})
        for name, path in again.items():
            self.assertEqual(path.read_bytes(), self.packages[name].read_bytes(), name)

    def test_documents_are_dated_by_source_date_epoch_alone(self):
        run(sys.executable, "-B", ROOT / "packaging/make_documents.py", COMMAND, "9.9", "Nobody <nobody@packages.invalid>",
            self.folder / "documents", env=os.environ | {"SOURCE_DATE_EPOCH": DATE})
        compressed = sorted((self.folder / "documents").rglob("*.gz"))
        self.assertEqual(len(compressed), len(self.pages) + 1)
        for path in compressed:
            content = path.read_bytes()
            self.assertEqual(content[4:8], bytes(4), f"{path.name}: RFC 1952: no date")
            self.assertRegex(gzip.decompress(content).decode(), "2023-11-14|Tue, 14 Nov 2023 22:13:20 .0000", path.name)


if __name__ == "__main__":
    unittest.main()
