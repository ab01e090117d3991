"""Runs examples/09_in_python with an installed package: python_example.py PREFIX FOLDER."""

import glob
import os
import subprocess
import sys

prefix, folder = sys.argv[1:]
(packages,) = glob.glob(os.path.join(prefix, "lib", "python3*", "dist-packages"))
environment = {**os.environ, "PYTHONPATH": packages, "PYTHONDONTWRITEBYTECODE": "1", "PATH": f"/usr/bin:{os.environ['PATH']}"}


def said(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, env=environment, timeout=60).stdout


def example(script):
    return said("python3", os.path.join(folder, script))


service = subprocess.Popen(["python3", os.path.join(folder, "service.py")], env=environment)
try:
    for script, expected in (("caller.py", "Hello, world!\n"), ("later.py", "['Hello, Ada!', 'Hello, Grace!']\n"),
                             ("algorithms.py", "Hi world [('Formal', 'Rejected'), ('Brief', 'Accepted')]\n")):  # fmt: skip
        if (told := example(script)) != expected:
            sys.exit(f"{script} said {told!r} in place of {expected!r}")
finally:
    service.terminate()
    code = service.wait(30)
if code != 0:
    sys.exit(f"service.py ended with {code}")
if "Hello, world!\n" not in (told := said(os.path.join(prefix, "bin", "skein"), "launch", os.path.join(folder, "mission.xml"))):
    sys.exit(f"the mission said {told!r}")
