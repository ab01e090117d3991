"""Compiles IDL that is not ours, what Debian's packages of omniORB and of the vendors bring, and compares with foreign_idl/PACKAGE.txt, which
says what compiles and what is refused, where and why. Ends with 77 where one of these packages is not installed.

foreign_idl_test.py SKEIN_ROOT CXX [--write]     (--write makes the lists anew)
"""

import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from compiler_run import run_compiler

FAST_DDS = "libfastrtps-dev" if os.path.isdir("/usr/include/fastrtps") else "libfastdds-dev"  # of release 2, of release 3
FOREIGN = {"omniorb-idl": "/usr/share/idl/omniORB", "cyclonedds-dev": "/usr/include/dds", FAST_DDS: "/usr/include/fastdds"}
LISTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "foreign_idl")
FINDING = re.compile(r"^(?P<path>[^:\s]+):(?P<line>\d+):\d+: error: (?P<reason>.*)$")


def foreign_files(root):
    """Their paths in that folder."""
    found = []
    for folder, _, names in os.walk(root):
        found += [os.path.relpath(os.path.join(folder, name), root) for name in names if name.endswith(".idl")]
    return sorted(found)


def verdict(root, folder, name, directory):
    """`compiles`, or the first error as `file:line: reason`."""
    code, told = run_compiler(root, f"-I{folder}", f"-I{folder}/COS", "--out", directory, os.path.join(folder, name))
    if code == 0:
        return "compiles"
    for line in told.splitlines():
        match = FINDING.match(line)
        if match:
            return f"{os.path.basename(match['path'])}:{match['line']}: {match['reason'].replace(folder + '/', '')}"
    return f"no reason given: {told[:200]!r}"


def check_cpp(root, compiler, directory, names):
    """Everything that compiled must be C++, all of it together."""
    all_in_one = os.path.join(directory, "all.cpp")
    with open(all_in_one, "w", encoding="utf-8") as stream:
        stream.writelines(f'#include "{name}.cpp"\n' for name in names)
    command = [compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", f"-I{root}/include"]
    command += [f"-I{directory}", f"-I{directory}/COS", all_in_one]
    return subprocess.run(command, timeout=300).returncode == 0


def compare(path, text):
    """Whether the list says so, too."""
    if "--write" in sys.argv:
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)
    with open(path, encoding="utf-8") as stream:
        expected = stream.read()
    differing = set(text.splitlines()) ^ set(expected.splitlines())
    for line in sorted(differing):
        print(("now:      " if line in text else "expected: ") + line)
    return not differing


def main():
    root, compiler = sys.argv[1:3]
    for package, folder in FOREIGN.items():
        if not os.path.isdir(folder):
            print(f"Skipped: the package {package} is not installed")
            return 77
    with tempfile.TemporaryDirectory() as directory:
        compiled, count, same = [], 0, True
        for package, folder in FOREIGN.items():
            verdicts = {name: verdict(root, folder, name, directory) for name in foreign_files(folder)}
            same &= compare(os.path.join(LISTS, f"{package}.txt"), "".join(f"{name}: {said}\n" for name, said in verdicts.items()))
            compiled += [name for name, said in verdicts.items() if said == "compiles"]
            count += len(verdicts)
        print(f"{len(compiled)} of {count} files compile")
        return 0 if check_cpp(root, compiler, directory, compiled) and same and compiled else 1


sys.exit(main())
