"""Compiles IDL that is not ours, what Debian's omniorb-idl, cyclonedds-dev and libfastrtps-dev bring, and compares with foreign_idl.txt, which
says what compiles and what is refused, where and why. Ends with 77 where one of these packages is not installed.

foreign_idl_test.py SKEIN_ROOT CXX [--write]     (--write makes the list anew)
"""

import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from compiler_run import run_compiler

FOREIGN = {"omniorb-idl": "/usr/share/idl/omniORB", "cyclonedds-dev": "/usr/include/dds", "libfastrtps-dev": "/usr/include/fastdds"}
LIST = os.path.join(os.path.dirname(os.path.abspath(__file__)), "foreign_idl.txt")
FINDING = re.compile(r"^(?P<path>[^:\s]+):(?P<line>\d+):\d+: error: (?P<reason>.*)$")


def foreign_files():
    """Their folders and their paths in them."""
    found = []
    for root in FOREIGN.values():
        for folder, _, names in os.walk(root):
            found += [(root, os.path.relpath(os.path.join(folder, name), root)) for name in names if name.endswith(".idl")]
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


def main():
    root, compiler = sys.argv[1:3]
    for package, folder in FOREIGN.items():
        if not os.path.isdir(folder):
            print(f"Skipped: the package {package} is not installed")
            return 77
    with tempfile.TemporaryDirectory() as directory:
        verdicts = {name: verdict(root, folder, name, directory) for folder, name in foreign_files()}
        text = "".join(f"{name}: {said}\n" for name, said in verdicts.items())
        if "--write" in sys.argv:
            with open(LIST, "w", encoding="utf-8") as stream:
                stream.write(text)
        with open(LIST, encoding="utf-8") as stream:
            expected = stream.read()
        differing = set(text.splitlines()) ^ set(expected.splitlines())
        for line in sorted(differing):
            print(("now:      " if line in text else "expected: ") + line)
        compiled = [name for name, said in verdicts.items() if said == "compiles"]
        print(f"{len(compiled)} of {len(verdicts)} files compile")
        return 0 if check_cpp(root, compiler, directory, compiled) and not differing and compiled else 1


sys.exit(main())
