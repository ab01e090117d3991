"""One IDL file through front end and back end."""

import os
import sys

import model
from back_end import ada_output, analysis, c_output, flattened, java_output, keys, output, python_output
from front_end import builder, parser, pragmas, source
from report import Place, Report, TooManyErrors


sys.setrecursionlimit(20000)  # levels of nested types and expressions


class Compilation:
    """Reads a file and says what is wrong with it; `accepted` if nothing is."""

    def __init__(self, path, folders, definitions, namespace=()):
        self._report = Report()
        self._folders = [os.path.join(os.path.abspath(folder), "") for folder in folders]
        self._built = None
        try:
            self._source = source.Source(path, folders, definitions, self._report)
            self._read(namespace)
        except TooManyErrors:
            pass  # of which the report told
        except RecursionError:
            self._report.error(Place(path, 1), "types or expressions in this file, or in what it includes, are nested too deeply")

    def _read(self, namespace):
        tree = parser.parse(self._source, self._report)
        self._built = builder.Builder(self._source, self._report, self._report.errors > 0, namespace)
        if tree is not None:
            self._built.build(tree)
            self._check_includes()
        if self.accepted:
            keys.apply(self._built, pragmas.keylists(self._source, self._built.scope_at, self._report), self._report)
        if self.accepted:
            analysis.analyse(self._built, self._report)

    def _check_includes(self):
        """The header of an included file is included outside of everything."""
        for written, path, place, offset in self._source.direct:
            if self._built.scope_at(offset) and self._built.declaring & {path, *self._source.included.get(path, ())}:
                self._report.error(place, f"'{written}' is included within '{'::'.join(self._built.scope_at(offset))}'; include it outside, and write the "
                                   "module in it")  # fmt: skip

    @property
    def accepted(self):
        return self._report.errors == 0

    @property
    def interfaces(self):
        """Those that the file itself defines; of an accepted file."""
        return self._built.interfaces

    @property
    def outermost_names(self):
        """Those of modules, and of all that stands in none, also in included files."""
        return {item.scope[0] for item in self._built.all_items if item.scope}

    @property
    def included_files(self):
        """Whole paths of all files that an accepted file includes: those that declare something, and the others."""
        included = self._source.included.get(self._source.path, ())
        declaring = [os.path.abspath(path) for path in included if path in self._built.declaring]
        return declaring, [os.path.abspath(path) for path in included if path not in self._built.declaring]

    def write(self, folder, name, depfile=None, language="c++"):
        """Writes what is made of an accepted file below `folder`: for `a/x.idl` `a/x.dds.idl`, `a/x.idl.hpp` and `a/x.idl.cpp` (`.h` and `.c` for C); for
        Python `a/x_idl.py` and `a/x_idl.pyi`."""
        file = model.File(
            path=self._source.path,
            header=os.path.basename(name) + ".hpp",
            includes=self._usable_includes(),
            items=self._built.items,
            interfaces=self._built.interfaces,
            announced=self._built.announced(),
            all_items=[item for item in self._built.all_items if item.place.file not in self._built.broken],
            included=self._source.included,
        )
        analysis.check_language(file.items, language, self._report)
        if not self.accepted:
            return
        base = os.path.join(folder, name)
        made = c_output if language == "c" else output
        of_its_own = {"ada": ada_output, "java": java_output, "python": python_output}
        if language in of_its_own:
            outputs = of_its_own[language].outputs(file, base, self._name_of)
        else:
            outputs = {  # in the order of skein_add_idl, which make and ninja ask for
                base.removesuffix(".idl") + ".dds.idl": flattened.text(file),
                base + (".h" if language == "c" else ".hpp"): made.header(file),
                base + (".c" if language == "c" else ".cpp"): made.source(file),
            }
        for path, lines in outputs.items():
            os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
            _write(path, "\n".join(lines).rstrip("\n") + "\n")
        if depfile:
            self._write_depfile(depfile, outputs)

    def _name_of(self, path):
        """The path of an included file from a folder that is searched, else its last part."""
        return next((path.removeprefix(folder) for folder in self._folders if path.startswith(folder)), os.path.basename(path))

    def _usable_includes(self):
        """Without included files that declare nothing, and those that have no output, because they were refused; nothing of them is used."""
        found = []
        for written, path, place, _ in self._source.direct:
            if not self._built.declaring & {path, *self._source.included.get(path, ())}:
                continue
            if path in self._built.broken:
                cause = self._built.broken[path].seen_from(self._source.path)
                self._report.warning(place, f"'{written}' cannot be compiled, see {cause}; nothing of it is used, and it is left out")
            else:
                found.append(self._within_a_folder(written, path))
        return found

    def _within_a_folder(self, written, path):
        """The path from a folder that is searched, where the written one leads out of it and back."""
        if ".." not in written.split("/"):
            return written
        path = os.path.abspath(path)
        return next((path.removeprefix(folder) for folder in self._folders if path.startswith(folder)), written)

    def _write_depfile(self, depfile, outputs):
        """Sources and this compiler itself: a change of either makes the outputs anew."""
        here = os.path.dirname(os.path.abspath(__file__))
        compiler = [os.path.join(folder, name) for folder, _, names in os.walk(here) for name in names if name.endswith((".py", ".lark"))]
        inputs = sorted({os.path.abspath(name) for name in self._source.files}) + sorted(compiler)
        targets = " ".join(_escaped(os.path.abspath(name)) for name in outputs)
        with open(depfile, "w", encoding="utf-8") as stream:
            stream.write(targets + ":" + "".join(f" \\\n  {_escaped(name)}" for name in inputs) + "\n")


def _write(path, text):
    """C++ that is as it was keeps its time, so that nothing is compiled anew; the flattened file shows that it was looked at."""
    if path.endswith(".dds.idl") or not _holds(path, text):
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)


def _holds(path, text):
    try:
        with open(path, encoding="utf-8") as stream:
            return stream.read() == text
    except (OSError, UnicodeDecodeError):
        return False


def _escaped(name):
    return name.replace("$", "$$").replace(" ", "\\ ").replace("#", "\\#")
