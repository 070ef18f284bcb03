"""Runs the Python code of docs/files/solution-file.md."""

import re
import subprocess
import sys
import unittest

from command import ROOT, CommandTest, room


class Checksums(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.interflect("solve", "room.mgf", "-o", "office.h5", "--rays", "1k", "--mesh-size", "none")
        text = (ROOT / "docs/files/solution-file.md").read_text().split("## Checksums")[1]
        self.write("verify.py", re.search(r"```python\n(.*?)```", text, re.DOTALL)[1])

    def verify(self):
        command = [sys.executable, "verify.py"]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=60)

    def test_are_as_documented(self):
        result = self.verify()
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_tell_which_part_is_damaged(self):
        content = bytearray(self.bytes("office.h5"))
        content[-1] ^= 4
        (self.folder / "office.h5").write_bytes(content)
        # The last array of the file is damaged.
        self.assertRegex(self.verify().stderr, r"AssertionError: /[a-z/_]+ is damaged")


if __name__ == "__main__":
    unittest.main()
