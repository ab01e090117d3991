"""image.py SOURCE PACKAGES: makes a container image of the Debian packages in a folder, and lets podman, which knows nothing of how it
was made, run it: alone, with no network but loopback, and with `skein launch` as PID 1."""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile

SKIPPED = 77
MOST_MB = 250
RECONNAISSANCE = "/usr/share/skein/mission_profiles/reconnaissance/reconnaissance.xml"


class Podman:
    """With a store of its own, and without the limits that a container as host may not set."""

    def __init__(self, folder):
        settings = folder / "containers.conf"
        settings.write_text("[containers]\ndefault_ulimits = []\n")
        os.environ["CONTAINERS_CONF"] = str(settings)
        self._words = ["podman", "--root", f"{folder}/store", "--runroot", f"{folder}/run", "--storage-driver", "vfs",
                       "--cgroup-manager", "cgroupfs", "--runtime", "runc"]

    def __call__(self, *words):
        done = subprocess.run([*self._words, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        return done.returncode, done.stdout

    def must(self, *words):
        code, text = self(*words)
        assert code == 0, f"podman {' '.join(words)} ended with {code}:\n{text}"
        return text

    def run(self, image, *words, options=()):
        return ["run", "--network=none", "--ulimit=host", "--cgroups=no-conmon", *options, image, *words]

    def follow(self, container, until):
        """Reads what it writes until that comes."""
        with subprocess.Popen([*self._words, "logs", "--follow", container], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as log:
            lines = []
            for line in log.stdout:
                lines.append(line)
                if until in line:
                    log.terminate()
                    return
        raise AssertionError(f"instead of '{until}':\n{''.join(lines)}")


def make(source, packages, file):
    subprocess.run([source / "dev", "image", file, packages], check=True)
    return hashlib.sha256(file.read_bytes()).hexdigest()


def files_in(image):
    with tarfile.open(image) as parts:
        layer, = json.load(parts.extractfile("manifest.json"))[0]["Layers"]
        with tarfile.open(fileobj=parts.extractfile(layer)) as root:
            return {name.removeprefix("./") for name in root.getnames()}


def test(source, packages, folder, podman):
    one, other = folder / "one.tar", folder / "other.tar"
    assert make(source, packages, one) == make(source, packages, other), "two images of the same packages differ"

    name = podman.must("load", "--input", str(one)).split()[-1]
    image = json.loads(podman.must("image", "inspect", name))[0]
    assert image["Config"]["Entrypoint"] == ["skein"], image["Config"]
    assert image["Size"] < MOST_MB * 1e6, f"{name} takes {image['Size'] / 1e6:.0f} MB"

    files = files_in(one)
    assert "etc/passwd" in files, files
    assert not files & {"etc/hostname", "etc/resolv.conf"}, "the image has files of the machine that made it"

    code, text = podman(*podman.run(name, "launch", RECONNAISSANCE))
    assert code == 0, f"the mission ended with {code}:\n{text}"
    assert "Complete: the aircraft has landed and stands" in text, text

    slow = ["launch", "--verbose", RECONNAISSANCE, "--variable", "speed_limit=1"]
    podman.must(*podman.run(name, *slow, options=["--detach", "--name=stopped"]))
    podman.follow("stopped", "processes are ready")
    podman.must("stop", "--time=60", "stopped")
    code, text = podman("wait", "stopped")
    assert text.strip() == "143", f"the launcher ended with {text}{podman('logs', 'stopped')[1]}"


def main(source, packages):
    missing = [program for program in ("podman", "runc", "mmdebstrap") if not shutil.which(program)]
    if missing:
        print(f"skipped: there is no {missing[0]}")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        podman = Podman(pathlib.Path(folder))
        try:
            test(pathlib.Path(source), packages, pathlib.Path(folder), podman)
        finally:
            podman("rm", "--all", "--force", "--time=0")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
