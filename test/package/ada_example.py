"""Builds examples/11_in_ada with an installed package, by gprbuild and by gnatmake, and runs it: ada_example.py PREFIX FOLDER."""

import glob
import os
import shutil
import subprocess
import sys
import tempfile

prefix, folder = sys.argv[1:]
(libraries,) = (os.path.dirname(each) for each in glob.glob(os.path.join(prefix, "**", "libskein_ada.a"), recursive=True))


def by_gprbuild(place):
    subprocess.run(["gprbuild", "-q", "-P", "in_ada.gpr", "-aP", os.path.join(prefix, "share", "gpr")], cwd=place, check=True)


def by_gnatmake(place):
    command = ["gnatmake", "-q", "-D", "build", "-Ibuild", f"-aI{prefix}/share/ada/adainclude/skein", f"-aO{libraries}/ada/adalib/skein"]
    for program in ("service", "caller"):
        subprocess.run([*command, program + ".adb", "-o", f"build/{program}",
                        "-largs", f"-L{libraries}", "-lskein_ada", "-lskein_c", f"-Wl,-rpath,{libraries}"], cwd=place, check=True)  # fmt: skip


def told(build):
    """What the caller prints."""
    with tempfile.TemporaryDirectory() as made:
        place = os.path.join(made, "in_ada")
        shutil.copytree(folder, place)
        idl = [os.path.join(prefix, "bin", "skein-idl"), "--language", "ada", "--out", "build", "greeter.idl"]
        subprocess.run(idl, cwd=place, check=True)
        build(place)
        service = subprocess.Popen([os.path.join(place, "build", "service")])
        try:
            return subprocess.run([os.path.join(place, "build", "caller")], check=True, stdout=subprocess.PIPE, text=True, timeout=60).stdout
        finally:
            service.terminate()
            if service.wait(30) != 0:
                sys.exit("the service did not end well")


for way in (by_gnatmake, by_gprbuild):
    if (said := told(way)) != "Hello, world!\nHello, later!\n":
        sys.exit(f"Caller, built {way.__name__}, said {said!r}")
