"""What the tests of Python share: the interfaces, the vendors of a pairing, and peers in other processes."""

import concurrent.futures
import contextlib
import os
import signal
import subprocess
import sys
import time

import skein

HERE = os.path.dirname(os.path.abspath(__file__))
harbour = skein.load("../c/buoy.idl").harbour
archive = skein.load("../c/archive.idl").harbour
odd = skein.load("odd.idl")
SERVER, CLIENT = os.environ.get("SKEIN_PAIRING", "loopback:loopback").split(":")
INSIDE = "loopback" in (SERVER, CLIENT)  # all entities are in one process
PATIENCE = 30


def entity(name, vendor, **options):
    return skein.Entity(name, system="uav-1", vendor=vendor, domain=17, **options)


def eventually(condition, patience=PATIENCE):
    """What the condition says once it holds; at last what it says by then."""
    end = time.monotonic() + patience
    while not (held := condition()) and time.monotonic() < end:
        time.sleep(0.005)
    return held


class Buoy(harbour.IBuoy):
    def __init__(self):
        self.forgotten = 0

    def wind(self, level, at):
        if level == 0:
            raise harbour.Fog("it lies low", at)
        return harbour.Wind(level, at * 2, harbour.Side.Starboard), 77

    def greet(self, name):
        return "Ahoy, " + name

    def forget(self):
        self.forgotten += 1

    def gusts(self, count):
        return (harbour.Wind(i, i + 0.5) for i in range(count))

    def after(self, ms):
        call = skein.current_call()
        eventually(lambda: call.cancelled, ms / 1000)
        return ms


class Peer:
    """A process that runs a script, or a program, and tells what happens by lines."""

    def __init__(self, *command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)

    @classmethod
    def python(cls, script, *arguments):
        return cls(sys.executable, "-B", "-c", f"import sys; sys.path.insert(0, {HERE!r})\nfrom tools import *\n" + script, *arguments)

    @classmethod
    def in_c(cls, vendor, side):
        return cls(os.environ["SKEIN_BUOY_PEER"], vendor, side)

    def expect(self, line):
        for told in self.process.stdout:
            if told.strip() == line:
                return self
        raise AssertionError(f"the peer ended, {self.process.wait()}, and did not say '{line}'")

    def kill(self, number=signal.SIGKILL):
        self.process.send_signal(number)

    def end(self):
        """Its exit code."""
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        code = self.process.wait(PATIENCE)
        self.process.stdout.close()
        return code

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.kill()
        self.end()


PROVIDES = """
class Telling(Buoy):
    def greet(self, name):
        if name == "nobody":
            print("called", flush=True)
            self.never = concurrent.futures.Future()
            return self.never
        return super().greet(name)

with entity("buoy", SERVER, lease=60) as own:
    own.provide(Telling())
    print("provides", flush=True)
    sys.stdin.read()
"""
