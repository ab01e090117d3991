"""GUIDE.md's table for those who come from ROS 2: what it says to type works, and what they would type leads there.

python3 ros_table_test.py GUIDE COMMAND PROVIDER, in a network of its own. PROVIDER is that of the first example."""

import codecs
import os
import pathlib
import re
import select
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import unittest

GUIDE, COMMAND, PROVIDER = (pathlib.Path(path) for path in sys.argv[1:4])
PLACE = pathlib.Path(__file__).parent
DOMAIN = "48"
PATIENCE_S = 30
# These go on until Ctrl-C, after which they have done what they are for.
ENDLESS = {"echo", "rate"}
# What each prints when it works, beside its exit code: regular expressions.
EXPECTED = {
    "peers": "uav-1/beacon",
    "topics": "pose",
    "echo": "north_m",
    "rate": "values/s",
    "publish": "published 1 value",
    "describe pose": "struct Pose",
    "services": "greeting/IGreeter",
    "call": "Hello, world!",
    "describe IGreeter": "string greet",
    "param": "Period",
    "param get": "100 ms",
    "param set": "Period = 200 ms",
    "record": r"pose +[1-9]",
    "info": r"pose .* [1-9]\d* messages",
    "replay": r"\b[1-9]\d* values published",
    "graph": "digraph",
    "doctor": r"\w",
}


def rows():
    text = GUIDE.read_text()
    table = text[text.index("| what you type in ROS 2 |") :].split("\n\n")[0]
    found = [re.findall(r"`([^`]+)`", line) for line in table.splitlines()[2:]]
    assert all(len(row) == 2 for row in found), found
    return found


def expected(words):
    return next(EXPECTED[name] for name in (" ".join(words[:2]), words[0]) if name in EXPECTED)


class Process:
    def __init__(self, words, folder=PLACE):
        environment = {**os.environ, "SKEIN_DOMAIN": DOMAIN}
        self.text = ""
        self.decoder = codecs.getincrementaldecoder("utf-8")()  # a read may end within a letter
        self.running = subprocess.Popen(words, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def read_until(self, part):
        """Whether it has written that; reads to its end where `part` is None."""
        output = self.running.stdout
        end = time.monotonic() + PATIENCE_S
        while part is None or part not in self.text:
            ready, _, _ = select.select([output], [], [], max(0, end - time.monotonic()))
            piece = os.read(output.fileno(), 65536) if ready else b""
            if not piece:
                return part is None and bool(ready)
            self.text += self.decoder.decode(piece)
        return True

    def end(self):
        """Its exit code, if need be after Ctrl-C."""
        if self.running.poll() is None:
            self.running.send_signal(signal.SIGINT)
        self.read_until(None)
        self.running.stdout.close()
        return self.running.wait(timeout=PATIENCE_S)


class Table(unittest.TestCase):
    def test_what_the_right_column_says_works(self):
        beacon = Process([COMMAND, "launch", "--verbose", "--no-log", "--only", "beacon", "patrol.xml"])
        self.addCleanup(beacon.end)
        self.assertTrue(beacon.read_until("beacon: ready"), beacon.text)
        greeter = Process([PROVIDER])
        self.addCleanup(greeter.end)
        with tempfile.TemporaryDirectory() as folder:
            for theirs, ours in rows():
                words = shlex.split(ours)[1:]
                if words[0] == "launch":  # which guide_flies_its_patrol does
                    continue
                if "IGreeter" in words or words[0] == "services":
                    words += ["--domain", "0"]
                if words[0] == "record":
                    words += ["--for", "2s"]
                with self.subTest(theirs=theirs, ours=ours):
                    run = Process([COMMAND, *words], folder)
                    wanted = expected(words) if words[0] in ENDLESS else None
                    self.assertTrue(run.read_until(wanted), run.text)
                    code = run.end()
                    self.assertIn(code, (0, 1) if words[0] == "doctor" else (0,), run.text)
                    self.assertRegex(run.text, expected(words))

    def test_what_the_left_column_says_leads_to_the_right_one(self):
        for theirs, ours in rows():
            words = theirs.removeprefix("ros2 ").split()
            ours = ours.split()
            if words[0] == ours[1] and words[:2] != ["param", "dump"]:
                continue  # the same words
            with self.subTest(theirs=theirs):
                done = subprocess.run([COMMAND, *words], capture_output=True, text=True, timeout=PATIENCE_S)
                self.assertEqual(done.returncode, 64, done.stderr)
                self.assertIn(f"in Skein: skein {ours[1]}", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
