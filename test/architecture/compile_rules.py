"""What only the compiler, or the linker's work, can tell."""

import os
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor

import include_rules


class Compiler:
    def __init__(self, command, include_folders):
        self._command = [command, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
        self._command += [f"-I{folder}" for folder in include_folders]

    def refusal(self, code):
        """What the compiler says against the code; empty where it takes it."""
        ran = subprocess.run([*self._command, "-x", "c++", "-"], input=code, text=True, capture_output=True, check=False)
        return ran.stderr if ran.returncode else ""

    def older_refusal(self, code):
        """What the preprocessor says against the code where it is C++17."""
        command = [*self._command, "-std=c++17", "-E", "-x", "c++", "-"]
        return subprocess.run(command, input=code, text=True, capture_output=True, check=False).stderr


# The header that needs more than Skein; asio_test includes it first, and is skipped where Asio is missing.
WITH_ASIO = "skein/asio.hpp"


def lone_headers(tree, compiler):
    """A public header that does not compile alone, or not twice."""
    headers = [path.removeprefix("include/") for path in tree.files((".hpp",), "include")]
    headers = [header for header in headers if header != WITH_ASIO]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        refusals = pool.map(lambda header: compiler.refusal(f'#include "{header}"\n#include "{header}"\n'), headers)
        for header, refusal in zip(headers, refusals):
            if refusal:
                yield f"include/{header}: does not compile alone:\n{_first_error(refusal)}"


def older_standard(tree, compiler):
    """A public header that does not say at first, to who compiles it as C++17, that it needs C++20."""
    for path in tree.files((".hpp",), "include"):
        if path == "include/" + WITH_ASIO or "/detail/" in path:
            continue
        first = _first_error(compiler.older_refusal(f'#include "{path.removeprefix("include/")}"\n'))
        if "Skein needs C++20" not in first:
            yield f"{path}: as C++17 it does not say at first that C++20 is needed: {first}"


def generated_version(header, compiler):
    """Generated code that would compile against other headers of Skein than its own."""
    text = _read(header).replace("#pragma once", "")  # which the main file of a compilation must not have
    if refusal := compiler.refusal(text):
        yield f"{header}: does not compile:\n{_first_error(refusal)}"
    older, changes = re.subn(r"SKEIN_IDL_VERSION == (\d+)", lambda found: f"SKEIN_IDL_VERSION == {int(found.group(1)) + 1}", text)
    if changes == 0:
        yield f"{header}: does not check the version of the headers"
    elif "build it anew" not in compiler.refusal(older):
        yield f"{header}: made for another version, it compiles all the same"


def generated_includes(header):
    """Generated code that knows more of Skein than floors 0 and 1."""
    for line, included in re.findall(r'^(#include "(skein/[^"]+)")', _read(header), re.MULTILINE):
        if include_rules.floor_of_header(included) not in ("core", "idl"):
            yield f"{header}: {line}: generated code knows core and idl alone"


def linked_vendors(library):
    """A vendor that libskein needs, though it is to be loaded at run time."""
    ran = subprocess.run(["readelf", "--dynamic", library], text=True, capture_output=True, check=True)
    for needed in re.findall(r"\(NEEDED\).*\[(.+)\]", ran.stdout):
        if re.match(include_rules.LOADED_LIBRARIES, needed):
            yield f"{library}: needs {needed}"


def open_search_paths(folders):
    """A program or library whose search path has an empty entry: the loader would look in the working folder."""
    for folder in folders:
        for name in sorted(os.listdir(folder)):
            path = os.path.join(folder, name)
            if not os.path.isfile(path) or os.path.islink(path) or _magic(path) != b"\x7fELF":
                continue
            ran = subprocess.run(["readelf", "--dynamic", path], text=True, capture_output=True, check=True)
            for places in re.findall(r"\((?:RUNPATH|RPATH)\).*\[(.*)\]", ran.stdout):
                if "" in places.split(":"):
                    yield f"{path}: its search path has an empty entry: {places}"


def _magic(path):
    with open(path, "rb") as stream:
        return stream.read(4)


def _read(path):
    with open(path, encoding="utf-8") as stream:
        return stream.read()


def _first_error(text):
    errors = [line for line in text.splitlines() if "error" in line]
    return "\n".join(errors[:3] or text.splitlines()[:3])
