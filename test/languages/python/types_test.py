"""What mypy --strict says of the package, of generated code, and of programs: types_test.py ROOT."""

import os
import subprocess
import sys
import tempfile
import unittest

ROOT = sys.argv.pop()

PROGRAM = """
import skein
from buoy_idl import harbour


class Buoy(harbour.IBuoy):
    def wind(self, level: int, at: float) -> tuple[harbour.Wind, int]:
        return harbour.Wind(level, at, harbour.Side.Port), 1

    async def greet(self, name: str) -> str:
        return name


def call(entity: skein.Entity) -> str:
    buoy = entity.connect(harbour.IBuoy, timeout=3)
    wind, stamp = buoy.wind(1, at=2.0)
    for gust in buoy.gusts(3):
        wind = gust
    depths = entity.publisher(harbour.Depth, "depth")
    depths.publish(harbour.Depth("quay", stamp))
    for depth in entity.subscribe(harbour.Depth, "depth"):
        return depth.place + buoy.within(1).asynchronous.greet("you").result() + harbour.Content(label="x").label
    return buoy.greet("you")


async def later(entity: skein.Entity) -> harbour.Report:
    reporter = await entity.async_connect(harbour.IReporter)
    return await reporter.report(harbour.Report(winds=[harbour.Wind()]))
"""
WRONG = """
def wrong(entity: skein.Entity, buoy: harbour.IBuoy.Proxy) -> None:
    buoy.greet(3)
    text: str = buoy.after(3)
    buoy.gust(3)
    entity.publisher(harbour.Depth, "depth").publish(harbour.Wind())
    harbour.Wind(force="x")
    harbour.Side.Nowhere


class Rude(harbour.IBuoy):
    def greet(self, name: str) -> int:
        return 3
"""


class Types(unittest.TestCase):
    def mypy(self, *arguments):
        environment = {**os.environ, "MYPYPATH": f"{ROOT}/src/languages/python:{self.folder}"}
        command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir", os.path.join(self.folder, "cache"), *arguments]
        return subprocess.run(command, capture_output=True, text=True, env=environment, cwd=self.folder, check=False)

    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        compiler = ["/usr/bin/python3", "-B", f"{ROOT}/idl/compiler", "--language", "python", "--out", self.folder]
        subprocess.run([*compiler, f"{ROOT}/test/languages/c/buoy.idl"], check=True)

    def lines(self, program):
        path = os.path.join(self.folder, "program.py")
        with open(path, "w", encoding="utf-8") as file:
            file.write(program)
        told = self.mypy(path).stdout
        return [int(line.split(":")[1]) for line in told.splitlines() if ": error:" in line], told

    def test_package_and_right_programs_are_accepted(self):
        checked = self.mypy("-p", "skein", "-m", "buoy_idl")
        self.assertEqual((checked.stdout, checked.returncode), ("", 0), checked.stderr)
        self.assertEqual(self.lines(PROGRAM), ([], ""))

    def test_each_wrong_line_is_found(self):
        first = PROGRAM.count("\n") + 1
        wrong = [first + at for at, line in enumerate(WRONG.splitlines()) if line.startswith("    ") and "return" not in line]
        found, told = self.lines(PROGRAM + WRONG)
        self.assertEqual(found, wrong, told)


if __name__ == "__main__":
    unittest.main(verbosity=2)
