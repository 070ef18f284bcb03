"""C++ files have no statements that are joined by commas, and no includes without use; the checks find such faults."""

import tempfile
import unittest
from pathlib import Path

from commas import joined_statements
from includes import unused_includes

ROOT = Path(__file__).resolve().parents[2]


def joined(text: str) -> list[str]:
    return [text[found.begin : found.end] for found in joined_statements(text)]


class Repository(unittest.TestCase):
    def test_has_no_joined_statements(self):
        files = [file for folder in ("include", "src", "apps", "python", "bench", "tests")
                 for file in sorted((ROOT / folder).rglob("*")) if file.suffix in (".h", ".cpp")]
        self.assertGreater(len(files), 500)
        self.assertEqual([f"{file}: {text}" for file in files for text in joined(file.read_text())], [])

    def test_has_no_unused_includes(self):
        self.assertEqual(unused_includes(ROOT), [])


class JoinedStatements(unittest.TestCase):
    def test_are_found(self):
        self.assertEqual(joined("void f() { x = 1, y = 2; }"), ["x = 1, y = 2"])
        self.assertEqual(joined("if (a(b, c)) ++x[i], y.z += 2;"), ["++x[i], y.z += 2"])
        self.assertEqual(joined("else\n  *p = 1, q->r(s, t);"), ["*p = 1, q->r(s, t)"])

    def test_other_commas_are_accepted(self):
        for text in ("int x = 1, y = 2;", "f(a, b);", "for (i = 0, j = 1; i < j; ++i, --j) f();", "x = f(a, b); // c, d;",
                     "const V3f a(1, 2, 3), b(4);", "return {a, b};", "enum class E { a, b };",
                     "std::vector<int> v{1, 2};", "template <class A, class B> void f(A a, B b);"):
            self.assertEqual(joined(text), [], text)


class UnusedIncludes(unittest.TestCase):
    def test_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name, text in (("src/interflect/base/box.h", "struct Box { int side; };\nint volume(Box box);\n"),
                               ("src/interflect/base/ball.h", "struct Ball {};\n"),
                               ("src/interflect/base/box.cpp", '#include "interflect/base/box.h"\n'),
                               ("src/interflect/a.cpp", '#include "interflect/base/box.h"\nint b = volume({1});\n'),
                               ("src/interflect/b.cpp", '#include "interflect/base/box.h"\n// Box\nBall ball;\n')):
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            found = unused_includes(root)
            self.assertEqual(len(found), 1, found)
            self.assertIn("b.cpp: uses nothing that interflect/base/box.h declares", found[0])


if __name__ == "__main__":
    unittest.main()
