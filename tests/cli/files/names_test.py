"""Names of arbitrary bytes: kept in files, escaped in JSON, and without effect on the terminal."""

import csv
import json
import os
import re
import subprocess
import unittest

from command import BAD_INPUT, COMMAND, DONE, PAINT, SMALL, VIEW, VIEWS, WRONG_USAGE, CommandTest, room, vertices

LATIN_1, ESCAPED = "büro\x1b[31m.mgf".encode("latin-1"), r"b\xfcro\x1b[31m.mgf"
COARSE = ("--rays", "10k", "--mesh-size", "none", "--method", "srr")


def is_control(byte):
    return byte < 0x20 and byte != 0x0A or byte == 0x7F


class Names(CommandTest):
    def run_bytes(self, *arguments, exit_code=DONE):
        words = [word if isinstance(word, bytes) else str(word).encode() for word in arguments]
        result = subprocess.run([COMMAND.encode(), *words], cwd=self.folder, capture_output=True, timeout=60)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        for output in (result.stdout, result.stderr):
            output.decode()  # raises unless it is UTF-8
            self.assertFalse(any(map(is_control, output)), output)
        return result

    def setUp(self):
        super().setUp()
        folder = os.fsencode(self.folder)
        material = room().encode().replace(b"paint", b"m\xe4rz")
        with open(os.path.join(folder, LATIN_1), "wb") as file:
            file.write(material.replace(b"lamp", b"l\xe4mp"))
        with open(os.path.join(folder, LATIN_1.replace(b".mgf", b".views.json")), "w") as file:
            file.write(json.dumps(VIEWS).replace("door", "door\\u001b]0;owned\\u0007\\nerror: fake"))

    def test_of_a_scene_survive_solving_and_drawing(self):
        self.run_bytes("solve", LATIN_1, "-o", b"l\xf6sung.h5", "--stats", "stats", *COARSE)
        header = json.loads((self.folder / "stats").read_text().splitlines()[0])
        self.assertEqual(header["scene"], ESCAPED)
        report = json.loads(self.run_bytes("info", b"l\xf6sung.h5", "--json").stdout)
        self.assertEqual(report["scene"], ESCAPED)
        self.assertEqual(report["files"][0], ESCAPED)
        self.run_bytes("render", b"l\xf6sung.h5", "-o", b"l\xf6sung.exr", *SMALL)
        with open(os.path.join(os.fsencode(self.folder), b"l\xf6sung.exr"), "rb") as file:
            self.assertIn(ESCAPED.encode(), file.read())

    def test_in_info(self):
        for options in ((), ("--json",)):
            text = self.run_bytes("info", LATIN_1, *options).stdout.decode().replace("\\\\", "\\")
            for name in (ESCAPED, r"l\xe4mp", r"door\x1b]0;owned\x07\x0aerror: fake"):
                self.assertIn(name, text)

    def test_in_messages_are_escaped(self):
        for arguments, exit_code in (
            (("info", b"no\xff\n\x1b[31m.mgf"), BAD_INPUT),
            (("render", LATIN_1, "-o", "x.png", "--view", b"\x9b2J\x7f"), BAD_INPUT),
            (("solve", LATIN_1, "-o", b"\x1b/out.h5"), BAD_INPUT),
            ((b"\x1b[2J\xc2\x9b",), WRONG_USAGE),
            (("solve", LATIN_1, "-o", "out.h5", "--rays", b"\x1b[2J\n"), WRONG_USAGE),
        ):
            with self.subTest(arguments=arguments):
                message = self.run_bytes(*arguments, exit_code=exit_code).stderr.decode()
                self.assertRegex(message, r"^error: .*\\x[0-9a-f]{2}")

    def test_change_neither_the_direction_of_text_nor_tables(self):
        """U+202E reverses the text after it; spreadsheets calculate cells that begin with one of = + - @."""
        names = ("evil\u202egpj", "=1+2", "+a", "-b", "@c", "'d", "plain")
        objects = "".join(
            f"{vertices((0, 0, z), (1, 0, z), (1, 1, z), (0, 1, z))}o {name}\nf v0 v1 v2 v3\no\n"
            for z, name in enumerate(names)
        )
        self.write("names.mgf", PAINT + objects)
        self.run_bytes("viewfactors", "names.mgf", "-o", "names.csv", "--rays", "10k")
        found = {row[0] for row in csv.reader((self.folder / "names.csv").read_text().splitlines())}
        escaped = r"evil\xe2\x80\xaegpj"
        self.assertEqual(found, {"from", escaped, "'=1+2", "'+a", "'-b", "'@c", "'d", "plain"})
        self.assertNotIn("\u202e", self.run_bytes("info", "names.mgf").stdout.decode())

    def test_can_begin_no_line_of_a_message(self):
        message = self.run_bytes("info", b"no\nerror: fake.mgf", exit_code=BAD_INPUT).stderr.decode()
        self.assertEqual(len(re.findall("^error: ", message, re.MULTILINE)), 1, message)

    def test_lists_of_faults_keep_their_lines(self):
        self.write("room.mgf", room())
        result = self.interflect("solve", "room.mgf", "-o", "out.h5", *VIEW, "--method", "wdrs", "--importance", "full", exit_code=BAD_INPUT)
        self.assertRegex(result.stderr, r"(?m)^error: .*:\n  importance: ")


if __name__ == "__main__":
    unittest.main()
