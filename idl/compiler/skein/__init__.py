"""omniidl back end: plain C++ types, proxies and skeletons for Skein, and flattened DDS IDL.

Run as: omniidl -p<this folder's parent> -bskein -Wbdirectory=OUT[,name=a/x.idl][,depfile=FILE] x.idl
"""

import os
import sys

import _omniidl

from . import analysis, builder, dependencies, errors, flattened, model, output, pragmas

# omniidl loads a back end before it parses. Comments before declarations are documentation, and
# `in Problem problem` is what everybody writes.
_omniidl.keepComments(1)
_omniidl.caseSensitive()

cpp_args = ["-C", "-D__SKEIN_IDL__"]  # keep comments
usage_string = """\
  -Wbdirectory=DIR  Where to write; default: the current directory
  -Wbname=PATH      Name of the output below DIR, `a/x.idl`; default: the input's last part
  -Wbdepfile=FILE   Write what the output depends on, as make and ninja read it"""


def run(tree, arguments):
    options = dict(argument.split("=", 1) for argument in arguments)
    name = options.get("name", os.path.basename(tree.file()))
    includes = dependencies.Includes(tree.file())
    report = errors.Report(includes.resolve)
    built = builder.Builder(report)
    built.build(tree)
    if not report.refused:
        analysis.analyse(built, report)
    if not report.refused:
        analysis.apply_pragmas(pragmas.collect(tree, includes.resolve), built, report, tree.file())
    if report.refused:
        sys.exit(1)
    file = model.File(
        path=tree.file(),
        header=os.path.basename(name) + ".hpp",
        includes=_usable(includes.direct, tree.file(), built.broken, report),
        items=built.items,
        interfaces=built.interfaces,
        announced=built.announced(),
    )
    base = os.path.join(options.get("directory", "."), name)
    stem = base.removesuffix(".idl")
    outputs = {
        base + ".hpp": output.header(file),
        base + ".cpp": output.source(file),
        stem + ".dds.idl": flattened.text(file),
    }
    os.makedirs(os.path.dirname(base) or ".", exist_ok=True)
    for path, lines in outputs.items():
        with open(path, "w", encoding="utf-8") as stream:
            stream.write("\n".join(lines).rstrip("\n") + "\n")
    if "depfile" in options:
        includes.write_depfile(options["depfile"], list(outputs))


def _usable(names, path, broken, report):
    """Without included files that have no output, because they were refused; nothing of them is used."""
    for name in set(names) & broken.keys():
        cause = report.where(broken[name])
        report.warning((path, 1), f"'{name}' cannot be compiled, see {cause}; nothing of it is used, and it is left out")
    return [name for name in names if name not in broken]
