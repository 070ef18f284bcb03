"""The public headers are a complete manual: their comments use only names that these headers declare.

Checked are names in backticks, calls `name()`, names with a scope (`Scene::origin`), names of several words (`RayCaster`,
`max_patches`), and files. A name without a scope must be declared outside of types, in an enclosing type, in the
declaration that the comment describes, or in a type that this declaration mentions.
"""

import re
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Patterns of names that no header declares, by their origin.
EXCEPTIONS = {
    "mathematics": r"sqrt|exp|log|log10|cos|phi|min|max|[A-Za-z]_\w+",  # F_ij, d_mean
    "the standard library": r"std::\w+|size",
    "other programs": r"AgX|NaN|OpenEXR|SciPy|csr_matrix|oconv .*|INTERFLECT_OIDN",
    "attributes and names in files": r"TEXCOORD_1|look_at",
    "variables of the example in interflect.h": r"ray_caster",
}
EXCEPTION = re.compile("|".join(EXCEPTIONS.values()))

NOT_CODE = re.compile(r'//[^\n]*|#[^\n]*|"[^"\n]*"|namespace (?:interflect::)?detail \{.*?\n\}', re.DOTALL)
COMMENT = re.compile(r"//[^\n]*")
FILE = re.compile(r"[\w/-]+\.(?:h|cpp|md)\b")
NAME = re.compile(rf"`[^`]+`|{FILE.pattern}|\w+(?:::\w+)+|\w{{2,}}(?=\(\S)|\b[A-Z]\w*[a-z][A-Z]\w*|\b\w+_\w+")
TYPE = re.compile(r"\b(?:struct|class|enum class)\s+(\w+)[^;{}()]*\{")


def block_end(code: str, start: int) -> int:
    """Returns the index of the brace that closes the one before `start`."""
    depth, i = 1, start
    while depth > 0:
        depth += {"{": 1, "}": -1}.get(code[i], 0)
        i += 1
    return i - 1


def declared(block: str) -> set[str]:
    """Returns the public names that a block declares outside of its own blocks and of lists of parameters."""
    for nested, rest in ((r"\{[^{}]*\}", ";"), (r"\([^()]*\)", " ( ")):
        while re.search(nested, block):
            block = re.sub(nested, rest, block)
    block = re.sub(r"=[^,;]*", "", block.partition("private:")[0])
    return set(re.findall(r"(\w+)\s*(?=[;,(]|$)", block))


class Header:
    def __init__(self, path: Path):
        self.path, self.text = path, path.read_text()
        self.code = NOT_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), self.text)  # at the same places
        self.types = [(match[1], match.end(), block_end(self.code, match.end())) for match in TYPE.finditer(self.code)]
        self.names = declared(self.code.partition("namespace interflect {")[2].rpartition("}")[0])

    def described(self, comment: re.Match) -> str:
        """Returns the declaration on the line of a comment, or the next one."""
        before = self.code[self.text.rfind("\n", 0, comment.start()) + 1:comment.start()]
        return before if before.strip() else re.split(r";|\{\n", self.code[comment.end():], maxsplit=1)[0]


def faults(root: Path) -> list[str]:
    """Returns 'file:line: problem' for each name in comments of the public headers below `root` that is not public."""
    folder = root / "include" / "interflect"
    headers = [Header(path) for path in sorted(folder.glob("*.h"))]
    members: dict[str, set[str]] = {}
    for header in headers:
        for name, start, end in header.types:
            members.setdefault(name, set()).update(declared(header.code[start:end]))
    everywhere = set().union(members, *(header.names for header in headers))

    def is_known(name: str, nearby: set[str]) -> bool:
        if FILE.fullmatch(name):
            return (folder / name).is_file() or (name.endswith(".md") and (root / name).is_file())
        scope, separator, last = name.removesuffix("()").rpartition("::")
        if separator:
            return last in members.get(scope.rpartition("::")[2], ())
        return all(part in nearby for part in last.split("."))

    found = []
    for header in headers:
        for comment in COMMENT.finditer(header.text):
            words = set(re.findall(r"\w+", header.described(comment)))
            near = words.union(name for name, start, end in header.types if start <= comment.start() < end)
            nearby = everywhere.union(words, *(members.get(name, ()) for name in near))
            place = f"{header.path}:{header.text.count(chr(10), 0, comment.start()) + 1}"
            found += [f"{place}: '{name}' is not declared in the public headers"
                      for name in (quoted.strip("`") for quoted in NAME.findall(comment[0]))
                      if not EXCEPTION.fullmatch(name) and not is_known(name, nearby)]
    return found


class HeaderComments(unittest.TestCase):
    maxDiff = None
    # A small header with two comments.
    HEADER = """namespace interflect {{
namespace detail {{
class Cell;
}}
struct Lamp {{
    float power = 1;  ///< {}
    float scaled(float factor) const {{ return factor * power; }}
  private:
    float hidden_power_;
}};
enum class Shape {{ box, ball }};
struct Room {{ Lamp lamp; float height() const; }};
/// {}
Lamp brightest(const Room& room, int count = {{}});
}}
"""

    def refused(self, member="", function=""):
        with tempfile.TemporaryDirectory() as root:
            folder = Path(root) / "include" / "interflect"
            folder.mkdir(parents=True)
            (folder / "lamp.h").write_text(self.HEADER.format(member, function))
            return [re.sub(r".*lamp.h:(\d+): '(.*)' is .*", r"\1 \2", fault) for fault in faults(Path(root))]

    def test_of_the_repository_name_what_is_public(self):
        self.assertEqual("\n".join(faults(ROOT)), "")

    def test_may_name_what_is_public(self):
        self.assertEqual(self.refused("`power`, scaled(), Room::height(), `Shape::ball`, lamp.h, brightest(room)",
                                      "`count`, `room.lamp`, height(), Lamp::power, `Shape`"), [])

    def test_may_not_name_anything_else(self):
        for name in ("`lumens`", "nearest()", "Room::width", "Lamp::hidden_power_", "lamp_table.cpp", "detail/cell.h",
                     "LightTree", "origin_for", "detail::Cell", "`Cell`", "docs/lamp.md", "`factor`", "`ball`"):
            self.assertEqual(self.refused(function=name), [f"13 {name.strip('`').removesuffix('()')}"], name)
        self.assertEqual(self.refused(member="height() of `count`"), ["6 height", "6 count"])


if __name__ == "__main__":
    unittest.main()
