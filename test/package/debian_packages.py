"""Installs Debian packages on a system without a compiler, and flies a mission there; then a user's programs are built on it.

debian_packages.py FOLDER SOURCE: the packages are FOLDER/*.deb; SOURCE is the tree that they were made of. The system is made in FOLDER/system,
from the Debian sources of this machine. Each command there has its own processes and, unless it installs something, its own network.
"""

import glob
import json
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import time

SKIPPED = 77
FLIGHT_SECONDS = 180  # from the end of the installation to that of the mission
PROFILE = "/usr/share/skein/mission_profiles/reconnaissance/reconnaissance.xml"
WITHIN = """set -e
mount -t proc proc "$1/proc"
mount -t sysfs sysfs "$1/sys"
mount -t tmpfs tmpfs "$1/dev/shm"
[ "$2" = outside ] || ip link set lo up
exec chroot "$1" /usr/bin/env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/pilot LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive sh -ec "$3"
"""


def run(*command, seconds):
    """Ends this program if the command fails or takes longer."""
    print("$", command[-1] if "\n" not in command[-1] else command[-1].strip(), flush=True)
    try:
        code = subprocess.run(command, stdin=subprocess.DEVNULL, timeout=seconds).returncode
    except subprocess.TimeoutExpired:
        sys.exit(f"it has not ended after {seconds:.0f} s")
    if code != 0:
        sys.exit(f"it ended with {code}")


class System:
    """A Debian in a folder."""

    def __init__(self, folder):
        self.folder = folder
        release = platform.freedesktop_os_release()["VERSION_CODENAME"]
        files = [*glob.glob("/etc/apt/sources.list"), *glob.glob("/etc/apt/sources.list.d/*.list"), *glob.glob("/etc/apt/sources.list.d/*.sources")]
        sources = [file for file in files if re.search(rf"\b{release}\b", pathlib.Path(file).read_text())]
        told = subprocess.run(["apt-config", "dump"], check=True, stdout=subprocess.PIPE, text=True).stdout
        options = re.findall(r"^Acquire::(?:Check-|https?::).*;$", told, re.M)
        shutil.rmtree(folder, ignore_errors=True)
        run("mmdebstrap", "--variant=minbase", "--skip=cleanup/apt/lists", *(f"--aptopt={each}" for each in options), release, folder, *sources, seconds=900)
        self.as_root("useradd --create-home --home-dir /pilot pilot")

    def as_root(self, script, seconds=900):
        self._within("outside", script, seconds)

    def as_user(self, script, seconds):
        self._within("loopback", f"cd /pilot\nexec setpriv --reuid=pilot --regid=pilot --clear-groups sh -ec '{script}'", seconds)

    def _within(self, network, script, seconds):
        own = [] if network == "outside" else ["--net"]
        run("unshare", "--mount", "--pid", "--fork", "--kill-child", *own, "sh", "-c", WITHIN, "sh", self.folder, network, script, seconds=seconds)


def judge(home):
    """What is wrong with the mission's own record of its flight."""
    report = json.loads((home / "reconnaissance.json").read_text())
    if report["verdict"] != "passed" or not report["flown"] or len(report["checks"]) < 9:
        return f"the mission was not passed: {report['verdict']}: {report.get('reason')}"
    if failed := [each["name"] for each in report["checks"] if not each["passed"]]:
        return f"the mission failed at {', '.join(failed)}"
    rows = (home / "reconnaissance.csv").read_text().count("\n")
    return f"its track has {rows} rows" if rows < 1000 else None


def main(folder, source):
    if os.geteuid() != 0 or not shutil.which("mmdebstrap"):
        print("skipped: only root makes a system, and only with mmdebstrap")
        sys.exit(SKIPPED)
    system = System(os.path.join(folder, "system"))
    home = pathlib.Path(system.folder, "pilot")
    os.mkdir(os.path.join(system.folder, "packages"))
    for package in glob.glob(os.path.join(folder, "*.deb")):
        shutil.copy(package, os.path.join(system.folder, "packages"))
    system.as_root("cd /packages\napt-get install -qq ./*.deb")
    system.as_root("! command -v cc c++ gcc g++ clang")
    began = time.monotonic()
    system.as_user(f"skein launch {PROFILE}", FLIGHT_SECONDS)
    print(f"flown within {time.monotonic() - began:.0f} s")
    if wrong := judge(home):
        sys.exit(wrong)

    # The user's programs, as README and guide begin.
    system.as_root("apt-get install -qq --no-install-recommends cmake g++ make pkg-config")
    shutil.copy(os.path.join(source, "test/package/first_service"), home)
    system.as_user("""
        cp -r /usr/share/doc/skein/examples/01_first_service /usr/share/doc/skein/examples/09_in_python .
        cmake -B cmake 01_first_service
        cmake --build cmake
        mkdir plain
        cd plain
        skein-idl ../01_first_service/greeter.idl
        for program in provider caller; do
          g++ -std=c++20 -I. ../01_first_service/$program.cpp greeter.idl.cpp $(pkg-config --cflags --libs skein) -o $program
        done""", 600)
    for build in ("cmake", "plain"):
        system.as_user(f"./first_service {build} cyclonedds fastdds", 60)
    system.as_user("""
        cd 09_in_python
        python3 service.py &
        [ "$(python3 caller.py)" = "Hello, world!" ]""", 60)
    shutil.rmtree(system.folder)


if __name__ == "__main__":
    main(*map(os.path.abspath, sys.argv[1:]))
