"""Builds examples/10_in_java with an installed package, and runs it: java_example.py PREFIX FOLDER."""

import glob
import os
import subprocess
import sys
import tempfile

prefix, folder = sys.argv[1:]
with tempfile.TemporaryDirectory() as build:
    environment = {**os.environ, "CLASSPATH": f"{build}:{prefix}/share/java/skein.jar:/usr/share/java/jna.jar"}

    def said(*command):
        return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment, timeout=60).stdout

    said(os.path.join(prefix, "bin", "skein-idl"), "--language", "java", "--out", build, os.path.join(folder, "greeter.idl"))
    said("javac", "-d", build, *glob.glob(f"{build}/greeting/*.java"), *glob.glob(f"{folder}/*.java"))
    service = subprocess.Popen(["java", "Service"], env=environment)
    try:
        told = said("java", "Caller")
    finally:
        service.terminate()
        service.wait(30)
if told != "Hello, world!\nHello, later!\n":
    sys.exit(f"Caller said {told!r}")
