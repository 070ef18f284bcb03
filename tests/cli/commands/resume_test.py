"""Checkpoints: a run that is killed at any time and resumed gives the same bytes as an undisturbed run."""

import signal
import subprocess
import time
import unittest

from command import BAD_INPUT, COMMAND, DONE, INTERRUPTED, VIEW, WRONG_USAGE, CommandTest, room

RUN = ("solve", "room.mgf", "--rays", "1M", "--mesh-size", "0.5")
METHODS = (("--method", "hsrr"), (*VIEW, "--method", "ihsrr"), ("--method", "global-lines"))  # SavedRun tests the state of all
OFTEN = ("--checkpoint", "run.h5", "--every", "0.1s")


class Resume(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def start_and_end(self, *arguments, signal_number, seconds):
        process = subprocess.Popen(
            [COMMAND, *arguments], cwd=self.folder, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL
        )
        time.sleep(seconds)
        process.send_signal(signal_number)
        process.wait()
        return process.returncode

    def kill_after_checkpoint(self, *arguments):
        """Kills the run as soon as it has a checkpoint; returns whether it was still running."""
        process = subprocess.Popen(
            [COMMAND, *arguments], cwd=self.folder, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL
        )
        while process.poll() is None and not (self.folder / "run.h5").exists():
            time.sleep(0.001)
        process.kill()
        return process.wait() == -signal.SIGKILL

    def kill_and_resume(self, whole, options, step, run=RUN):
        """Kills the run after its first checkpoint, then repeatedly, each time a little later, until it completes."""
        checkpoint = self.folder / "run.h5"
        for _ in range(20):  # on a busy machine, a fast run can end before it is killed
            checkpoint.unlink(missing_ok=True)
            if self.kill_after_checkpoint(*run, *options, "-o", "killed.h5", *OFTEN):
                break
        else:
            self.fail("every run ended before it was killed")
        resume, kills = ("resume", "run.h5", "-o", "killed.h5", *OFTEN), 0
        while self.start_and_end(*resume, signal_number=signal.SIGKILL, seconds=0.1 + step * kills) != DONE:
            kills += 1
        self.assertEqual(self.bytes("killed.h5"), whole)

    def test_a_run_that_is_killed_and_resumed_has_the_bytes_of_one_left_alone(self):
        for options in METHODS:
            with self.subTest(options=options):
                self.interflect(*RUN, *options, "-o", "whole.h5")
                whole = self.bytes("whole.h5")
                self.kill_and_resume(whole, options, step=0.07)
                self.assertEqual([f.name for f in self.folder.glob("*.part*")], [])

    def test_light_from_outside_is_aimed_at_the_same_places(self):
        far = "v a =\n\tp 300 300 0\nv b =\n\tp 301 300 0\nv c =\n\tp 300 301 0\nm paint\nf a b c\n"
        self.write("open.mgf", room().replace("f v2 v3 v7 v6\n", "") + far)
        run, options = ("solve", "open.mgf", "--rays", "400k"), (*VIEW, "--sky", "clear", "--sun", "20,35")
        self.interflect(*run, *options, "-o", "whole.h5")
        self.kill_and_resume(self.bytes("whole.h5"), options, step=0.07, run=run)

    def test_goes_on_to_other_limits_and_keeps_the_previous_checkpoint(self):
        self.interflect(*RUN, "-o", "a.h5", "--checkpoint", "run.h5")
        first = self.bytes("run.h5")
        self.interflect("resume", "run.h5", "-o", "b.h5", "--rays", "2M", "--stats", "stats.jsonl")
        self.assertEqual(self.bytes("run.previous.h5"), first)
        info = self.json("info", "b.h5", "--json")
        self.assertEqual(info["result"]["rays"], 2_000_000)
        self.interflect("render", "run.h5", "-o", "picture.png", *VIEW, "--size", "32x18")

    def test_an_unrelated_file_with_the_name_of_the_previous_checkpoint_is_not_replaced(self):
        self.write("other.mgf", room())
        self.interflect("solve", "other.mgf", "--rays", "1k", "-o", "result.h5", "--checkpoint", "other.h5")
        for name in ("other.h5", "result.h5", "other.mgf"):  # a run of another scene, a result, and no solution at all
            content = self.bytes(name)
            (self.folder / "run.previous.h5").write_bytes(content)
            for again in (RUN, ("resume", "own.h5")):
                if again is not RUN:
                    self.interflect(*RUN[:3], "1k", "-o", "a.h5", "--checkpoint", "own.h5")
                before = self.files()
                error = self.interflect(*again, "-o", "out.h5", "--checkpoint", "run.h5", exit_code=WRONG_USAGE).stderr
                self.assertIn("'run.previous.h5' is to keep the last checkpoint but one", error)
                self.assertEqual(self.bytes("run.previous.h5"), content)
                self.assertEqual(self.files(), before)
            for own in ("own.h5", "own.previous.h5"):
                (self.folder / own).unlink(missing_ok=True)

    def test_only_a_run_of_the_scene_becomes_the_previous_checkpoint(self):
        (self.folder / "run.h5").write_text("the user's own")
        self.interflect(*RUN[:3], "1k", "-o", "a.h5", "--checkpoint", "run.h5")
        self.assertFalse((self.folder / "run.previous.h5").exists())
        first = self.bytes("run.h5")
        self.interflect(*RUN[:3], "2k", "-o", "a.h5", "--checkpoint", "./run.h5")
        self.assertEqual(self.bytes("run.previous.h5"), first)

    def test_both_checkpoints_may_be_one_file(self):
        """They are if the disk was too full for the last one."""
        self.interflect(*RUN[:3], "1k", "-o", "a.h5", "--checkpoint", "run.h5")
        (self.folder / "run.previous.h5").hardlink_to(self.folder / "run.h5")
        first = self.bytes("run.h5")
        self.interflect("resume", "run.h5", "-o", "b.h5", "--rays", "2k")
        self.assertEqual(self.bytes("run.previous.h5"), first)

    def test_the_previous_checkpoint_of_a_link_is_a_file(self):
        (self.folder / "disk").mkdir()
        (self.folder / "run.h5").symlink_to("disk/run.h5")
        self.interflect(*RUN[:3], "1k", "-o", "a.h5", "--checkpoint", "run.h5")
        first = self.bytes("disk/run.h5")
        self.interflect(*RUN[:3], "2k", "-o", "a.h5", "--checkpoint", "run.h5")
        self.assertEqual(self.bytes("run.previous.h5"), first)
        self.assertNotEqual(self.bytes("disk/run.h5"), first)

    def test_ctrl_c_keeps_a_state_to_go_on_from(self):
        self.interflect(*RUN, "-o", "whole.h5")
        code = self.start_and_end(*RUN, "-o", "cut.h5", "--checkpoint", "run.h5", signal_number=signal.SIGINT, seconds=0.3)
        if code == INTERRUPTED:  # else the run was faster
            self.interflect("resume", "run.h5", "-o", "resumed.h5")
            whole, resumed = self.bytes("whole.h5"), self.bytes("resumed.h5")
            self.assertEqual(resumed, whole)
        else:
            self.assertIn(code, (DONE, -signal.SIGINT))

    def test_what_cannot_be_resumed_is_refused(self):
        self.interflect("solve", "room.mgf", "--rays", "1k", "-o", "result.h5")
        (self.folder / "run.previous.h5").write_bytes(self.bytes("result.h5"))
        for arguments, reason, exit_code in (
            (("resume", "result.h5", "-o", "out.h5"), "not its state", BAD_INPUT),
            (("resume", "room.mgf", "-o", "out.h5"), "a checkpoint is a solution file", BAD_INPUT),
            ((*RUN, "-o", "out.h5", "--checkpoint", "run.mgf"), "ends in .h5", WRONG_USAGE),
            ((*RUN, "-o", "out.h5", "--checkpoint", "out.h5"), "same file", WRONG_USAGE),
            ((*RUN, "-o", "run.previous.h5", "--checkpoint", "run.h5"), "the previous checkpoint", WRONG_USAGE),
            (("resume", "run.previous.h5", "-o", "out.h5", "--checkpoint", "run.h5"), "same file", WRONG_USAGE),
        ):
            with self.subTest(arguments=arguments):
                self.assertIn(reason, self.interflect(*arguments, exit_code=exit_code).stderr)


if __name__ == "__main__":
    unittest.main()
