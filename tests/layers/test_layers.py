"""The repository follows its own rules, and the checker finds each violation."""

import tempfile
import unittest
from pathlib import Path

from layers import faults

ROOT = Path(__file__).resolve().parents[2]


class Repository(unittest.TestCase):
    def test_keeps_the_rules(self):
        self.assertEqual(faults(ROOT), [])


class Checker(unittest.TestCase):
    """Small trees of sources, each with at most one fault."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("base/CMakeLists.txt", "interflect_folder(base SOURCES colour.cpp)")
        self.write("base/colour.h", "#pragma once\n")
        self.write("scene/CMakeLists.txt", "interflect_folder(scene\n  SOURCES scene.cpp\n  USES base\n  LINKS fmt)")
        self.write("scene/core/core.h", '#pragma once\n#include "interflect/base/colour.h"\n')

    def write(self, name, text):
        path = self.root / "src" / "interflect" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def assert_only_fault(self, file, words):
        found = faults(self.root)
        self.assertEqual(len(found), 1, found)
        self.assertIn(file, found[0])
        self.assertIn(words, found[0])

    def test_a_sound_tree_has_no_fault(self):
        self.assertEqual(faults(self.root), [])

    def test_include_of_a_later_layer(self):
        self.write("base/colour.cpp", '#include "interflect/scene/core/core.h"\n')
        self.assert_only_fault("base/colour.cpp", "interflect/scene/")

    def test_include_of_an_undeclared_layer(self):
        self.write("solver/CMakeLists.txt", "interflect_folder(solver SOURCES solve.cpp USES base)")
        self.write("solver/solve.cpp", '#include "interflect/scene/core/core.h"\n')
        self.assert_only_fault("solver/solve.cpp", "interflect/scene/")

    def test_public_header_that_needs_one_that_is_not(self):
        self.write("../../include/interflect/scene.h", '#pragma once\n#include "interflect/scene/core/core.h"\n')
        self.assert_only_fault("include/interflect/scene.h", "not installed")

    def test_private_header_in_a_program(self):
        self.write("../../apps/viewer/main.cpp", '#include "interflect/base/files/escapes.h"\n#include "interflect/scene.h"\n')
        self.assertEqual(faults(self.root), [])
        self.write("../../apps/viewer/main.cpp", '#include "interflect/solver/light/materials.h"\n')
        self.assert_only_fault("apps/viewer/main.cpp", "interflect/solver/light/materials.h, which is not for programs")

    def test_use_of_a_later_layer(self):
        self.write("base/CMakeLists.txt", "interflect_folder(base SOURCES colour.cpp USES scene)")
        self.assert_only_fault("base/CMakeLists.txt", "USES scene")

    def test_two_types_of_one_name(self):
        self.write("base/facet.h", "#pragma once\nstruct Facet {\n    int patch;\n};\n")
        self.write("base/other.h", "#pragma once\nstruct Facet : Base {\n    float area;\n};\n")
        self.assert_only_fault("base/other.h", "another type is called Facet")

    def test_unknown_layer(self):
        self.write("gadgets/CMakeLists.txt", "interflect_folder(gadgets SOURCES gadget.cpp)")
        self.assert_only_fault("gadgets", "not one of the layers")

    def test_internal_header_with_public_names(self):
        self.write("base/colour.h", "#pragma once\nnamespace interflect {\nstruct Colour;\n}\n")
        self.assert_only_fault("base/colour.h", "is for public headers")

    def test_public_header_with_internal_names(self):
        declared = "namespace interflect::detail {\nclass Cell;\n}\n"
        self.write("../../include/interflect/scene.h", f"#pragma once\n{declared}")
        self.assertEqual(faults(self.root), [])
        self.write("../../include/interflect/scene.h", f"#pragma once\n{declared.replace(';', ' { int x; };')}")
        self.assert_only_fault("include/interflect/scene.h", "forward declarations alone")

    def write_solver(self, name, text):
        self.write("solver/CMakeLists.txt", "interflect_folder(solver SOURCES solve.cpp USES base)")
        self.write(f"solver/{name}", text)

    def test_include_from_an_earlier_folder_of_the_solver(self):
        self.write_solver("transport/transport.cpp", '#include "interflect/solver/sampling/payload.h"\n')
        self.assertEqual(faults(self.root), [])

    def test_include_from_a_later_folder_of_the_solver(self):
        self.write_solver("sampling/payload.cpp", '#include "interflect/solver/transport/transport.h"\n')
        self.assert_only_fault("sampling/payload.cpp", "not before solver/sampling")

    def test_include_of_the_main_loop(self):
        self.write_solver("methods/passes.cpp", '#include "interflect/solver/run.h"\n')
        self.assert_only_fault("methods/passes.cpp", "not before solver/methods")

    def test_unknown_folder_of_the_solver(self):
        self.write_solver("gadgets/gadget.cpp", "")
        self.assert_only_fault("gadgets", "not one of the folders of solver")

    def test_folders_with_too_many_files(self):
        for i in range(13):
            self.write_solver(f"light/light_{i}.cpp", "")
        self.assert_only_fault("solver/light", "13 files")

    def test_folder_of_tests_with_too_many_files(self):
        for i in range(12):
            self.write(f"../../tests/solver/case_{i}.cpp", "")
            self.write(f"../../docs/figures/figure_{i}.svg", "")
        self.write("../../docs/figures/figure_12.svg", "")
        self.assertEqual(faults(self.root), [])
        self.write("../../tests/solver/.hidden", "")
        self.assertEqual(faults(self.root), [])
        self.write("../../tests/solver/case_12.cpp", "")
        self.assert_only_fault("tests/solver", "13 files")

    def test_message_with_an_option_of_the_command_line(self):
        self.write("base/colour.cpp", 'throw InputError("too many; \\"x\\" --max-patches raises it");\n')
        self.assert_only_fault("base/colour.cpp", "names an option of the command line")

    def test_decrements_and_comments_are_no_messages(self):
        self.write("base/colour.cpp", 'return f("a", --count, "b");  // see solve --stats\n')
        self.assertEqual(faults(self.root), [])

    def test_header_without_guard(self):
        self.write("scene/core/view.h", "struct View;\n")
        self.assert_only_fault("scene/core/view.h", "#pragma once")

    def test_using_namespace_in_a_header(self):
        self.write("scene/core/view.h", "#pragma once\nusing namespace interflect;\n")
        self.assert_only_fault("scene/core/view.h", "using namespace")


if __name__ == "__main__":
    unittest.main()
