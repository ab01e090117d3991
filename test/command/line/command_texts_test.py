"""What the build made of the command line: completion, as each shell does it, and manual pages, as readers of them take them.

python3 command_texts_test.py COMMAND FOLDER, which holds man1/ and completion/."""

import os
import pathlib
import pty
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

COMMAND = pathlib.Path(sys.argv[1])
FOLDER = pathlib.Path(sys.argv[2])


class Hints(unittest.TestCase):
    def check(self, line, *texts):
        done = subprocess.run([COMMAND, *line.split()], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 64)
        for text in texts:
            self.assertIn(text, done.stderr)

    def test_options_follow_the_command(self):
        self.check("--domain 42 services", "options follow the command: skein services --domain 42")
        self.check("--domain 42", "options follow the command: skein COMMAND --domain 42")

    def test_a_global_option_that_is_misspelt_is_told_with_the_nearest(self):
        self.check("--verison", "there is no option '--verison' (did you mean '--version'?)")
        self.check("--hlep", "did you mean '--help'?")

    def test_a_profile_is_an_option_of_commands_that_look(self):
        self.check("services mission.xml", "--profile mission.xml")

    def test_once_is_a_count_of_one(self):
        self.check("echo pose --once", "--count 1")
        self.check("publish pose 1 --once", "--count 1")

    def test_short_options_of_others_lead_to_those_that_there_are(self):
        self.check("record -o x.mcap", "-o (--output does that)")
        self.check("replay x.mcap -r 2", "-r (--rate does that)")
        self.check("peers -d 61", "-d (--domain does that)")
        self.check("record -a", "-a (all is taken unless an option says otherwise)")

    def test_a_mission_flies_on_the_domain_of_its_profile(self):
        self.check("launch mission.xml --domain 61", "--domain (the profile says it: <mission domain=")

    def test_help_is_an_option(self):
        self.check("help", "skein --help, skein COMMAND --help")

    def test_a_mission_is_stopped_where_it_was_launched(self):
        self.check("stop", "Ctrl-C in the launch's terminal")

    def test_unexpected_words_keep_their_order(self):
        self.check("services -n 1", "not expected: -n 1")


def needs(program):
    return unittest.skipUnless(shutil.which(program), f"{program} is not installed")


class InShell(unittest.TestCase):
    """Completes in an empty folder but for mission.xml."""

    before = ""  # what stands before Skein in the path

    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        (pathlib.Path(self.place.name) / "mission.xml").touch()
        (pathlib.Path(self.place.name) / "logs").mkdir()

    def environment(self):
        path = f"{self.before}{COMMAND.parent}:{os.environ['PATH']}"
        return {**os.environ, "HOME": self.place.name, "TERM": "dumb", "LC_ALL": "C.UTF-8", "PATH": path}

    def run_shell(self, *words):
        done = subprocess.run(words, cwd=self.place.name, env=self.environment(), capture_output=True, text=True, timeout=60)
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.returncode, 0)
        return done.stdout

    def check_all(self):
        self.assertEqual(self.complete("skein ser"), ["services"])
        self.assertEqual(self.complete("skein bench "), ["compare", "discovery", "latency", "throughput"])
        self.assertEqual(self.complete("skein services --st"), ["--statistics"])
        self.assertEqual(self.complete("skein bench latency --pay"), ["--payload"])
        self.assertEqual(self.complete("skein services --pay"), [])
        self.assertEqual(self.complete("skein services --vendor "), ["cyclonedds", "fastdds"])
        self.assertEqual(self.complete("skein launch --dry-run mis"), ["mission.xml"])
        self.assertEqual(self.complete("skein calls --profile m"), ["mission.xml"])
        self.assertEqual(self.complete("skein services --interface l"), ["lo"])
        self.assertEqual(self.complete("skein services --wait "), [])
        self.assertEqual(self.complete("skein completion f"), ["fish"])
        self.check_live()

    def check_live(self):
        """Names that a domain has now, as a command in place of Skein's tells them, with what it was asked."""
        told = self.stand_in()
        self.assertEqual(self.complete("skein echo po"), ["pose"])
        self.assertEqual(told(), ["complete -- echo po"])
        self.assertIn("pose", self.complete("skein call --domain 47 "))
        self.assertIn("complete -- call --domain 47 ", told())
        self.assertFalse((pathlib.Path(self.place.name) / "evil").exists())

    def stand_in(self):
        """Puts a command before Skein's; what it gives tells, and forgets, with which words that was called."""
        folder = pathlib.Path(self.place.name) / "bin"
        folder.mkdir()
        calls = folder / "calls"
        calls.touch()
        program = folder / "skein"
        program.write_text(f"#!/bin/sh\necho \"$*\" >> {calls}\necho pose; echo '$(touch evil)'\n")
        program.chmod(0o755)
        self.before = f"{folder}:"

        def told():
            lines = calls.read_text().splitlines()
            calls.write_text("")
            return lines

        return told


class Bash(InShell):
    def complete(self, line):
        words = line.split() + ([""] if line.endswith(" ") else [])
        return self.complete_words(words)

    def complete_words(self, words):
        script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _skein; printf "%s\\n" "${COMPREPLY[@]}"'
        return sorted(self.run_shell("bash", "-uc", script, "bash", FOLDER / "completion/skein", *words).split())

    def test_completes(self):
        self.check_all()

    def test_completes_a_value_behind_an_equals_sign_which_bash_takes_for_a_word(self):
        self.assertEqual(self.complete_words(["skein", "services", "--vendor", "=", "fast"]), ["fastdds"])
        self.assertEqual(self.complete_words(["skein", "services", "--vendor", "="]), ["cyclonedds", "fastdds"])

    def test_asks_a_domain_that_stands_behind_an_equals_sign(self):
        told = self.stand_in()
        self.assertEqual(self.complete_words(["skein", "echo", "--domain", "=", "47", "po"]), ["pose"])
        self.assertEqual(told(), ["complete -- echo --domain 47 po"])

    def test_takes_the_value_of_an_option_for_no_argument(self):
        self.assertEqual(self.complete("skein peer --set a.b=1 mis"), ["mission.xml"])
        self.assertEqual(self.complete("skein peer mission.xml mis"), [])
        self.assertEqual(self.complete("skein peer mission.xml navigator mis"), [])

    def test_registers_itself(self):
        script = 'source "$1"; complete -p skein'
        self.assertEqual(
            self.run_shell("bash", "-uc", script, "bash", FOLDER / "completion/skein").strip(), "complete -F _skein skein"
        )

    def test_is_found_by_the_package_bash_completion(self):
        package = pathlib.Path("/usr/share/bash-completion/bash_completion")
        if not package.exists():
            self.skipTest("bash-completion is not installed")
        data = pathlib.Path(self.place.name) / "share/bash-completion/completions"
        data.mkdir(parents=True)
        shutil.copy(FOLDER / "completion/skein", data)
        script = 'XDG_DATA_DIRS=$PWD/share; source "$1"; _completion_loader skein; complete -p skein'
        self.assertEqual(self.run_shell("bash", "-c", script, "bash", package).strip(), "complete -F _skein skein")


@needs("fish")
class Fish(InShell):
    def complete(self, line):
        script = f'source {FOLDER / "completion/skein.fish"}; complete -C "{line}"'
        lines = self.run_shell("fish", "--no-config", "-c", script).splitlines()
        return sorted(text.split("\t")[0] for text in lines)

    def test_completes(self):
        self.check_all()


@needs("zsh")
class Zsh(InShell):
    def test_is_a_script_that_is_loaded_by_its_name(self):
        self.run_shell("zsh", "-n", FOLDER / "completion/_skein")
        script = 'fpath=("$1" $fpath); autoload -Uz compinit; compinit -u -D; print $_comps[skein]; autoload +X _skein'
        self.assertEqual(self.run_shell("zsh", "-fc", script, "zsh", FOLDER / "completion").strip(), "_skein")

    def test_completes(self):
        self.assertEqual(self.complete("skein ser"), "skein services ")
        self.assertEqual(self.complete("skein bench thr"), "skein bench throughput ")
        self.assertEqual(self.complete("skein services --st"), "skein services --statistics ")
        self.assertEqual(self.complete("skein services --vendor f"), "skein services --vendor fastdds ")
        self.assertEqual(self.complete("skein launch --dry-run mis"), "skein launch --dry-run mission.xml ")
        self.assertEqual(self.complete("skein services --interface l"), "skein services --interface lo ")

    def complete(self, line):
        """The line after the tab key, in a terminal: only there does zsh complete."""
        pid, terminal = pty.fork()
        if pid == 0:
            os.chdir(self.place.name)
            os.execvpe("zsh", ["zsh", "-f", "-i"], self.environment())
        try:
            setup = f"PS1=; fpath=({FOLDER / 'completion'} $fpath); autoload -Uz compinit; compinit -u -D;"
            setup += " show() { print -r -- \"<$BUFFER>\" }; zle -N show; bindkey ^T show; print rea''dy"
            os.write(terminal, setup.encode() + b"\n")
            self.read_until(terminal, b"ready\r\n")
            os.write(terminal, line.encode() + b"\t\x14")
            shown = self.read_until(terminal, b">")
            return shown[shown.rindex(b"<") + 1 : shown.rindex(b">")].decode()
        finally:
            os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
            os.close(terminal)

    def read_until(self, terminal, end):
        read = b""
        while end not in read:
            readable, _, _ = select.select([terminal], [], [], 60)
            self.assertTrue(readable, f"nothing more after {read}")
            read += os.read(terminal, 4096)
        return read


class Manual(unittest.TestCase):
    def pages(self):
        found = sorted((FOLDER / "man1").glob("*.1"))
        self.assertGreater(len(found), 8)
        return found

    def check_with(self, *words):
        for page in self.pages():
            with self.subTest(page=page.name):
                done = subprocess.run([*words, page], capture_output=True, text=True, timeout=60)
                self.assertEqual(done.stdout + done.stderr, "")
                self.assertEqual(done.returncode, 0)

    @needs("groff")
    def test_groff_has_nothing_to_warn_of(self):
        self.check_with("groff", "-man", "-ww", "-z")

    @needs("mandoc")
    def test_mandoc_has_nothing_to_warn_of(self):
        # A page has no date of its own: the same source makes the same page.
        done = subprocess.run(["mandoc", "-T", "lint", *self.pages()], capture_output=True, text=True, timeout=60)
        self.assertEqual([line for line in done.stdout.splitlines() if "missing date" not in line], [])

    def test_there_is_one_for_each_command(self):
        names = {page.stem for page in self.pages()}
        done = subprocess.run([COMMAND, "--help"], capture_output=True, text=True, timeout=60, check=True)
        commands = [line.split()[0] for line in done.stdout.split("Exit codes:")[0].splitlines() if line.startswith("  ") and line[2].isalpha()]
        self.assertIn("launch", commands)
        for command in commands:
            self.assertIn(f"skein-{command}", names)
        self.assertIn("skein", names)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
