#!/usr/bin/env python3
"""An interrupted bake ends with 130, says so, and leaves old files as they were."""
import signal
import subprocess
import time
import unittest

from lambert_cli import DATA, INTERRUPTED, PROGRAM, ProgramTest

BUSY_SECONDS = 0.5  # of processor time: more than starting takes, far less than the bake
LIMIT = 300


def processor_seconds(pid):
    with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as stat:
        fields = stat.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100  # utime, stime


def is_computing(pid):
    """Whether the process has its signal handlers (they precede the computation) and has worked for a while."""
    with open(f"/proc/{pid}/status", encoding="ascii", errors="replace") as status:
        caught = next(int(line.split()[1], 16) for line in status if line.startswith("SigCgt:"))
    return caught & 1 << (signal.SIGINT - 1) and processor_seconds(pid) > BUSY_SECONDS


class Interrupt(ProgramTest):
    LONG = ("bake", DATA / "cornell_box.obj", "--patches", "20000", "--resolution", "512")
    LONG_BY_LIGHTS = ("bake", DATA / "cornell_box.obj", "--patches", "20000", "--method", "instant-radiosity", "--vpls", "1000000")

    def interrupt(self, number, command=LONG):
        targets = [self.write(name, f"old {name}") for name in ("box.glb", "box.png", "box.json")]
        glb, png, json = targets
        arguments = [PROGRAM, *map(str, (*command, "-o", glb, "--image", png, "--json", json))]
        with subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            try:
                while process.poll() is None and not is_computing(process.pid):
                    time.sleep(0.02)
                process.send_signal(number)
                output, errors = process.communicate(timeout=LIMIT)
            finally:
                process.kill()
        self.assertEqual(process.returncode, INTERRUPTED, errors)
        self.assertEqual(errors.splitlines()[-1], "lambert: interrupted")
        self.assertEqual(output, "")
        self.assertEqual(sorted(self.folder.iterdir()), sorted(targets))
        for target in targets:
            self.assertEqual(target.read_text(), f"old {target.name}")

    def test_ctrl_c_leaves_old_files_untouched(self):
        self.interrupt(signal.SIGINT)

    def test_ctrl_c_leaves_old_files_untouched_while_virtual_lights_are_gathered(self):
        self.interrupt(signal.SIGINT, self.LONG_BY_LIGHTS)

    def test_sigterm_leaves_old_files_untouched(self):
        self.interrupt(signal.SIGTERM)


if __name__ == "__main__":
    unittest.main()
