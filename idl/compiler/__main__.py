"""The command skein-idl: compiles IDL to C++, Ada, C, Java and Python, and to plain DDS IDL."""

import argparse
import os
import re
import sys

import component
import model
import names
from back_end.ada_names import Clash
from compilation import Compilation
from front_end import source
from report import printable

_IDL = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
_OWN_FOLDERS = [os.path.join(_IDL, "skein"), os.path.join(_IDL, "corba")]  # behind those that the user names


_USAGE_ERROR = 64  # as of Skein's other commands


class _Options(argparse.ArgumentParser):
    def error(self, message):
        self.print_usage(sys.stderr)
        self.exit(_USAGE_ERROR, f"{self.prog}: {printable(message)}; see `{self.prog} --help`\n")


def main():
    arguments = _arguments()
    accepted = sum(_compiled(path, arguments) for path in arguments.files)
    if arguments.check:
        print(f"files {len(arguments.files)} accepted {accepted}")
    return 0 if accepted == len(arguments.files) else 1


def _arguments():
    options = _Options(prog="skein-idl", description="Compiles IDL (OMG IDL 4.2) to C++, Ada, C, Java and Python, and to plain DDS IDL.")
    options.add_argument("files", metavar="FILE", nargs="+", help="x.idl becomes x.idl.hpp, x.idl.cpp and x.dds.idl")
    options.add_argument("-I", dest="folders", metavar="DIR", action="append", default=[],
                         help="look for included files there; the output of a file below DIR keeps its path from there")  # fmt: skip
    options.add_argument("-D", dest="definitions", metavar="NAME[=VALUE]", action="append", default=[], help="define a macro")
    options.add_argument("--output", "--out", dest="out", metavar="DIR", default=".", help="where to write; default: the current folder")
    options.add_argument("--namespace", metavar="NAME", type=_namespace, default=(),
                         help="put all C++ names into this namespace, `a::b`; included files must be compiled with the same")  # fmt: skip
    options.add_argument("--depfile", metavar="FILE", help="write what the output depends on, as make and ninja read it")
    options.add_argument("--language", choices=tuple(model.LANGUAGES), default="c++",
                         help="`c`: x.idl becomes x.idl.h and x.idl.c; `python`: x_idl.py and x_idl.pyi; `ada`: x_idl.ads and x_idl.adb; default: c++")  # fmt: skip
    options.add_argument("--check", action="store_true", help="write nothing, say every problem, and count the accepted files")
    arguments = options.parse_args()
    if arguments.depfile and len(arguments.files) > 1:
        options.error("--depfile is of a single FILE")
    return arguments


def _namespace(text):
    parts = tuple(text.split("::"))
    if not all(re.fullmatch("[A-Za-z_][A-Za-z0-9_]*", part) and part not in names.KEYWORDS for part in parts):
        raise argparse.ArgumentTypeError(f"'{text}' is no namespace of C++, such as a::b")
    return parts


def _compiled(path, arguments):
    if not os.path.isfile(path):
        return _refused(path, "it is no file" if os.path.exists(path) else "there is no such file")
    if os.path.getsize(path) > source.LARGEST:
        return _refused(path, f"the file has more than {source.LARGEST >> 20} MiB; divide it into files that include each other")
    compilation = Compilation(path, [*arguments.folders, *_OWN_FOLDERS], arguments.definitions, arguments.namespace)
    if compilation.accepted and not arguments.check:
        try:
            compilation.write(arguments.out, _name(path, [*arguments.folders, *_OWN_FOLDERS]), arguments.depfile, arguments.language)
        except Clash as clash:
            return _refused(path, str(clash))
        except OSError as error:
            return _refused(error.filename or arguments.out, f"cannot be written: {error.strerror}; name another folder by --output")
    return compilation.accepted


def _refused(path, reason):
    sys.stderr.write(printable(f"{path}: error: {reason}") + "\n")
    return False


def _name(path, folders):
    """The path from the first folder that holds the file, else its last part."""
    path = os.path.abspath(path)
    for folder in map(os.path.abspath, folders):
        if path.startswith(os.path.join(folder, "")):
            return os.path.relpath(path, folder)
    return os.path.basename(path)


sys.exit(component.main(sys.argv[2:]) if sys.argv[1:2] == ["--component"] else main())
