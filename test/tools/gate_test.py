"""gate_test.py CMAKE: what the gate makes of tests that pass, fail, fail by luck, crash and break invariants; which tests a change concerns."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).parent
sys.path[:0] = [str(TOOLS), str(TOOLS.parent / "architecture")]

from affected_tests import Affected, changed_files  # noqa: E402
from cores import Cores  # noqa: E402
from source_tree import SourceTree  # noqa: E402

CMAKE = sys.argv.pop() if len(sys.argv) > 1 else "cmake"

PROJECT = """cmake_minimum_required(VERSION 3.25)
project(scripted NONE)
enable_testing()
add_subdirectory(test/area)
"""
PRESETS = """{"version": 6, "configurePresets": [{"name": "default", "generator": "Ninja", "binaryDir": "${sourceDir}/build"}],
"testPresets": [{"name": "default", "configurePreset": "default", "output": {"outputOnFailure": true}}]}"""


def cores_are_kept():
    """Whether a process that dies leaves its core where the gate looks."""
    pattern = pathlib.Path("/proc/sys/kernel/core_pattern")
    return "SKEIN_CORES" in os.environ or (pattern.read_text().strip() == "core" and os.access(pattern, os.W_OK))


class CoresTest(unittest.TestCase):
    def test_a_core_belongs_to_the_test_in_its_own_environment_whatever_its_process_has_read_of_others(self):
        with tempfile.TemporaryDirectory() as folder:
            os.environ["SKEIN_CORES"], before = folder, os.environ.get("SKEIN_CORES")
            try:
                (pathlib.Path(folder) / "core.1").write_bytes(b"\0SKEIN_TEST_NAME=other\0\x01SKEIN_TEST_NAME=own\0HOME=/\0")
                (pathlib.Path(folder) / "core.2").write_bytes(b"\0HOME=/\0")
                with Cores() as cores:
                    found = {name: [core.name for core in of_it] for name, of_it in cores.by_test().items()}
            finally:
                os.environ.pop("SKEIN_CORES")
                if before is not None:
                    os.environ["SKEIN_CORES"] = before
        self.assertEqual(found, {"own": ["core.1"], "": ["core.2"]})


class Gate(unittest.TestCase):
    """A project whose tests are lines of shell."""

    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        shutil.copytree(TOOLS, self.root / "test" / "tools", ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(TOOLS.parents[1] / "ARCHITECTURE.md", self.root)
        shutil.copytree(TOOLS.parent / "architecture", self.root / "test" / "architecture", ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(TOOLS.parents[1] / "ARCHITECTURE.md", self.root)
        (self.root / "CMakeLists.txt").write_text(PROJECT)
        (self.root / "CMakePresets.json").write_text(PRESETS)
        (self.root / "test" / "area").mkdir()
        self.tests = []

    def add(self, name, script, labels="real;floor_3"):
        path = self.root / f"{name}.sh"
        path.write_text(f"cd {self.root}\n{script}\n")
        properties = f'ENVIRONMENT_MODIFICATION SKEIN_TEST_NAME=set:{name}'
        if labels:
            properties += f' LABELS "{labels}"'
        self.tests.append(f"add_test(NAME {name} COMMAND bash {path})\nset_tests_properties({name} PROPERTIES {properties})\n")

    def run_gate(self, *arguments):
        (self.root / "test" / "area" / "CMakeLists.txt").write_text("".join(self.tests))
        subprocess.run([CMAKE, "--preset", "default"], cwd=self.root, check=True, capture_output=True)
        run = subprocess.run([self.root / "test" / "tools" / "run_tests.py", "default", *arguments], cwd=self.root,
                             capture_output=True, text=True, check=False)
        self.said = run.stdout + run.stderr
        return run.returncode

    def times(self, name):
        """How often a test ran that counts itself by `echo >>NAME.times`."""
        counted = self.root / f"{name}.times"
        return len(counted.read_text().split("\n")) - 1 if counted.exists() else 0

    def assertSaid(self, *parts):
        for part in parts:
            self.assertIn(part, self.said)

    def test_what_passes_passes(self):
        self.add("good", "true")
        self.assertEqual(self.run_gate(), 0)
        self.assertSaid("100% tests passed, 0 tests failed out of 1", "default: 0 failed for good, 0 suspects")

    def test_who_fails_once_is_a_suspect_with_reason_load_and_log(self):
        self.add("unlucky", 'echo >>unlucky.times; echo "x.cpp:7: FAILED:"; echo "  CHECK( soon )"; [ $(wc -l <unlucky.times) -gt 1 ]')
        self.assertEqual(self.run_gate(), 0)
        self.assertSaid("suspect unlucky (default): x.cpp:7: FAILED: CHECK( soon ); load ", "build/suspects/unlucky.default.log",
                        "passed when run again (1)", "0 failed for good, 1 suspects")
        self.assertIn("x.cpp:7", (self.root / "build/suspects/unlucky.default.log").read_text())

    def test_who_fails_three_times_has_failed(self):
        self.add("broken", "echo >>broken.times; false")
        self.assertNotEqual(self.run_gate(), 0)
        self.assertEqual(self.times("broken"), 3)
        self.assertSaid("broken (default): Failed", "failed 3 times")

    def test_logic_is_not_run_again(self):
        self.add("wrong", "echo >>wrong.times; false", "logic;floor_0")
        self.assertNotEqual(self.run_gate(), 0)
        self.assertEqual(self.times("wrong"), 1)
        self.assertSaid("of class logic, which is not run again")

    def test_a_broken_invariant_is_not_run_again(self):
        self.add("twice", 'echo >>twice.times; echo "  INVARIANT( twice == 0 )"; false')
        self.assertNotEqual(self.run_gate(), 0)
        self.assertEqual(self.times("twice"), 1)
        self.assertSaid("never run again: a broken invariant")

    def test_a_broken_invariant_in_the_second_run_counts(self):
        self.add("later", 'echo >>later.times; [ $(wc -l <later.times) -gt 1 ] && echo "  INVARIANT( a == b )"; false')
        self.assertNotEqual(self.run_gate(), 0)
        self.assertEqual(self.times("later"), 2)

    def test_a_crash_is_not_run_again(self):
        self.add("crash", "echo >>crash.times; kill -SEGV $$")
        self.assertNotEqual(self.run_gate(), 0)
        self.assertEqual(self.times("crash"), 1)
        self.assertSaid("never run again: a crash")

    def test_a_crash_of_a_child_is_not_run_again(self):
        self.add("parent", "echo >>parent.times; bash -c 'kill -SEGV $$'; exit 1")
        self.assertNotEqual(self.run_gate(), 0)
        self.assertSaid("failed for good")
        if cores_are_kept():
            self.assertEqual(self.times("parent"), 1)
            self.assertSaid("a crash of one of its processes")

    def test_a_crash_in_a_further_run_counts_though_the_test_passes_then(self):
        self.add("later", "echo >>later.times; [ $(wc -l <later.times) -gt 1 ] || exit 1; bash -c 'kill -SEGV $$'; exit 0")
        code = self.run_gate()
        if cores_are_kept():
            self.assertNotEqual(code, 0)
            self.assertSaid("a crash of one of its processes in a further run")

    def test_a_crash_in_a_test_that_passes_is_told(self):
        self.add("calm", "bash -c 'kill -SEGV $$'; exit 0")
        self.assertEqual(self.run_gate(), 0)
        if cores_are_kept():
            self.assertSaid("suspect calm (default): passed, though one of its processes died by a signal")

    def test_a_further_run_that_is_skipped_is_no_pass(self):
        self.add("lazy", "echo >>lazy.times; [ $(wc -l <lazy.times) -gt 1 ] && exit 77; exit 1")
        self.tests.append("set_tests_properties(lazy PROPERTIES SKIP_RETURN_CODE 77)\n")
        self.assertNotEqual(self.run_gate(), 0)

    def test_a_further_run_has_the_same_seed(self):
        self.add("chance", 'echo "${SKEIN_SEED:-none}" >>chance.times; echo SKEIN_SEED=77; [ $(wc -l <chance.times) -gt 1 ]')
        self.assertEqual(self.run_gate(), 0)
        self.assertEqual((self.root / "chance.times").read_text().split(), ["none", "77"])

    def test_an_invariant_at_the_end_of_much_output_is_seen(self):
        self.add("talker", "echo >>talker.times; head -c 9000000 /dev/zero | tr '\\0' 'x'; echo '  INVARIANT( a == b )'; exit 1")
        self.assertNotEqual(self.run_gate(), 0)
        self.assertEqual(self.times("talker"), 1)

    def test_many_failures_are_no_luck(self):
        for number in range(6):
            self.add(f"bad{number}", f"echo >>bad{number}.times; false")
        self.assertNotEqual(self.run_gate(), 0)
        self.assertEqual([self.times(f"bad{number}") for number in range(6)], [1] * 6)

    def test_what_a_sanitizer_reports_is_not_run_again(self):
        for number, text in enumerate(("==7==ERROR: AddressSanitizer: heap-use-after-free", "WARNING: ThreadSanitizer: data race",
                                       "x.cpp:3:4: runtime error: signed integer overflow", "AddressSanitizer:DEADLYSIGNAL")):
            self.add(f"san{number}", f'echo >>san{number}.times; echo "{text}"; false')
        self.assertNotEqual(self.run_gate(), 0)
        self.assertEqual([self.times(f"san{number}") for number in range(4)], [1, 1, 1, 1])

    def test_long_tests_are_run_by_long_alone_or_by_name(self):
        self.add("short", "echo >>short.times")
        self.add("soak", "echo >>soak.times", "long;floor_3")
        self.add("fuzz", "echo >>fuzz.times", "real;floor_3;lengthened")
        self.run_gate()
        self.assertEqual((self.times("short"), self.times("soak"), self.times("fuzz")), (1, 0, 1))
        self.run_gate("--long")
        self.assertEqual((self.times("short"), self.times("soak"), self.times("fuzz")), (1, 1, 2))
        self.run_gate("-R", "soak")
        self.assertEqual(self.times("soak"), 2)
        self.run_gate("-LE", "lengthened")
        self.assertEqual((self.times("short"), self.times("soak"), self.times("fuzz")), (2, 2, 2))

    def test_a_test_without_a_class_or_a_floor_is_refused(self):
        self.add("nobody", "true", "floor_3")
        self.assertNotEqual(self.run_gate(), 0)
        self.assertSaid("nobody", "skein_test_class")

    def test_who_is_in_quarantine_is_reported_and_does_not_block(self):
        self.add("ill", "false")
        ledger = self.root / "test" / "SUSPECTS.md"
        ledger.write_text("# Suspects\n\n## Quarantine\n\n| test | reason |\n|---|---|\n| `ill` | leases of 1 s |\n")
        self.assertEqual(self.run_gate(), 0)
        self.assertSaid("quarantined ill", "leases of 1 s")
        ledger.write_text(ledger.read_text() + "".join(f"| `t{i}` | because |\n" for i in range(3)))
        self.assertNotEqual(self.run_gate(), 0)
        self.assertSaid("4 tests in quarantine")

    def test_a_run_that_is_ended_ends_its_tests(self):
        self.add("sleeper", "echo >>sleeper.times; exec sleep 60")
        (self.root / "test" / "area" / "CMakeLists.txt").write_text("".join(self.tests))
        subprocess.run([CMAKE, "--preset", "default"], cwd=self.root, check=True, capture_output=True)
        with subprocess.Popen([self.root / "test" / "tools" / "run_tests.py", "default"], cwd=self.root, stdout=subprocess.PIPE, text=True) as run:
            while "Start 1: sleeper" not in run.stdout.readline():
                pass
            run.terminate()
            self.assertNotEqual(run.wait(timeout=20), 0)

    def test_changed_runs_what_can_be_broken(self):
        git = ["git", "-C", self.root, "-c", "user.name=x", "-c", "user.email=x@y"]
        self.add("low", "echo >>low.times", "logic;floor_1")
        self.add("high", "echo >>high.times", "logic;floor_6")
        (self.root / ".gitignore").write_text("build/\n*.times\n*.sh\n__pycache__/\n")
        (self.root / "src" / "entity").mkdir(parents=True)
        (self.root / "src" / "entity" / "head.cpp").write_text("\n")
        (self.root / "test" / "area" / "CMakeLists.txt").write_text("".join(self.tests))
        subprocess.run([*git, "init", "-q"], check=True)
        subprocess.run([*git, "add", "-A"], check=True)
        subprocess.run([*git, "commit", "-q", "-m", "x"], check=True)
        (self.root / "src" / "entity" / "head.cpp").write_text("int a;\n")
        self.assertEqual(self.run_gate("--changed=HEAD"), 0)
        self.assertEqual((self.times("low"), self.times("high")), (0, 1))
        self.assertSaid("1 files differ from HEAD: 1 of 2 tests can tell")
        self.assertNotEqual(self.run_gate("--changed=HEAD", "-R", "low"), 0)
        self.assertSaid("exclude each other")
        self.assertNotEqual(self.run_gate("--changed=nowhere"), 0)
        self.assertSaid("git knows no commit 'nowhere'")


class Stages(unittest.TestCase):
    def run_stages(self, folder, *commands):
        run = subprocess.run([TOOLS / "stages", *commands], cwd=folder, capture_output=True, text=True, check=False)
        return run.returncode, run.stdout

    def test_they_run_in_order_and_the_last_line_counts_tests(self):
        with tempfile.TemporaryDirectory() as folder:
            said = "100% tests passed, 0 tests failed out of 5"
            code, text = self.run_stages(folder, "echo", "lint", "--", "echo", said)
            self.assertEqual(code, 0)
            self.assertTrue(text.endswith(said + "\n"), text)
            self.assertIn("=== 1 of 2: echo lint; how long it takes is not known here yet", text)
            self.assertIn("=== 1 of 2: echo lint; some 1 minutes left", self.run_stages(folder, "echo", "lint", "--", "echo", said)[1])

    def test_the_first_that_fails_is_the_last(self):
        with tempfile.TemporaryDirectory() as folder:
            code, text = self.run_stages(folder, "true", "--", "false", "--", "echo", "after")
            self.assertEqual(code, 1)
            self.assertNotIn("=== 3", text)

    def test_what_was_not_tested_is_told_before_the_counts_and_stops_nothing(self):
        said, why = "100% tests passed, 0 tests failed out of 5", "NOT TESTED: a release: no root"
        with tempfile.TemporaryDirectory() as folder:
            code, text = self.run_stages(folder, "echo", said, "--", "sh", "-c", f"echo '{why}'; exit 77", "--", "echo", "after")
            self.assertEqual(code, 0)
            self.assertIn("\nafter\n", text)
            self.assertTrue(text.endswith(f"\n=== {why}\n{said}\n"), text)
            self.assertIn("how long it takes is not known", self.run_stages(folder, "sh", "-c", f"echo '{why}'; exit 77")[1])

    def test_one_that_tested_nothing_and_does_not_say_why_has_failed(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.run_stages(folder, "sh", "-c", "exit 77")[0], 77)
            self.assertEqual(self.run_stages(folder, "sh", "-c", "echo 'NOT TESTED: a release: no root'; exit 1")[0], 1)


@unittest.skipIf(os.getuid() != 0, "on_trixie makes itself root")
class OtherRelease(unittest.TestCase):
    """on_trixie, with stand-ins for the tools that make a Debian system and run in it."""

    def run_on_trixie(self, debian_root, in_root):
        with tempfile.TemporaryDirectory() as folder:
            tools = pathlib.Path(folder) / "test" / "tools"
            tools.mkdir(parents=True)
            shutil.copy(TOOLS / "on_trixie", tools)
            for name, script in (("debian_root", debian_root), ("in_root", in_root)):
                (tools / name).write_text(f"#!/bin/sh\n{script}\n")
                (tools / name).chmod(0o755)
            log = pathlib.Path(folder) / "log"  # which what ran before has begun
            with log.open("w", encoding="utf-8") as before:
                before.write("before\n")
                before.flush()
                run = subprocess.run([tools / "on_trixie", "-R", "x"], stdout=subprocess.PIPE, stderr=before, text=True, check=False,
                                     env=os.environ | {"SUDO_UID": "1", "SUDO_GID": "1"})
            self.owner = tools.stat().st_uid
            self.log = log.read_text(encoding="utf-8")
        return run.returncode, run.stdout

    def test_without_an_archive_it_says_what_debian_root_said_last(self):
        code, text = self.run_on_trixie("echo first >&2; echo no archive >&2; exit 1", "true")
        self.assertEqual((code, text), (77, "NOT TESTED: Debian 13: test/tools/debian_root failed: no archive\n"))
        self.assertEqual(self.log, "before\nfirst\nno archive\n")

    def test_without_mounts_it_says_so(self):
        code, text = self.run_on_trixie("true", "echo unshare failed >&2; exit 1")
        self.assertEqual((code, text), (77, "NOT TESTED: Debian 13: test/tools/in_root failed: unshare failed\n"))

    def test_what_fails_there_fails(self):
        code, text = self.run_on_trixie("true", 'shift; [ "$1" = true ] || { echo "$@"; exit 8; }')
        self.assertEqual((code, text), (8, "./dev trixie -R x\n"))
        self.assertEqual(self.owner, 1)


class Selection(unittest.TestCase):
    """What a change in this very tree can break."""

    TREE = SourceTree(str(TOOLS.parents[1]))

    def floor(self, *paths):
        return Affected(self.TREE, paths).floor

    def test_a_source_breaks_its_floor_and_those_above(self):
        self.assertEqual(self.floor("src/core/text.cpp"), 0)
        self.assertEqual(self.floor("src/dds/fastdds/fast_reader.cpp"), 2)
        self.assertEqual(self.floor("include/skein/head.hpp"), 6)
        self.assertEqual(self.floor("brokerless_discovery/table.cpp"), 4)
        self.assertEqual(self.floor("src/navigation/planners/prm.cpp"), 7)
        self.assertEqual(self.floor("src/command/mission/check.cpp", "src/entity/head.cpp"), 6)
        affected = Affected(self.TREE, ["src/entity/head.cpp"])
        self.assertFalse(affected.breaks(5, "connector"))
        self.assertTrue(affected.breaks(6, "entity"))

    def test_a_file_of_tests_breaks_its_folder(self):
        affected = Affected(self.TREE, ["test/core/text_test.cpp"])
        self.assertTrue(affected.breaks(0, "core"))
        self.assertFalse(affected.breaks(8, "mission"))

    def test_what_nobody_can_tell_may_break_all(self):
        for path in ("CMakeLists.txt", "dev", "test/tools/cable.cpp", "test/connector/echo_service.cpp", "src/CMakeLists.txt", "src/unknown/x.cpp"):
            self.assertEqual(self.floor(path), 0, path)

    def test_texts_concern_those_who_read_the_tree(self):
        affected = Affected(self.TREE, ["README.md"])
        self.assertTrue(affected.breaks(8, "architecture"))
        self.assertFalse(affected.breaks(8, "mission"))
        self.assertTrue(Affected(self.TREE, ["benchmarks/README.md"]).breaks(8, "benchmarks"))

    def test_an_unknown_commit_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["git", "init", "-q", folder], check=True)
            with self.assertRaises(ValueError):
                changed_files(folder, "nowhere")


if __name__ == "__main__":
    unittest.main()
