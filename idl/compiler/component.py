"""A new component: C++ that compiles, its description, and the project that builds the plugin. `skein new` runs it."""

import argparse
import os
import re
import shlex
import sys
import tempfile

import names
from back_end import cpp, interface_template
from compilation import Compilation
from front_end import parser
from report import printable, suggestion

_REFUSED, _USAGE, _UNWRITTEN, _INTERRUPTED = 78, 64, 74, 130  # as of Skein's other commands
_IDL = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
_NAVIGATION = os.path.join(_IDL, "navigation")  # of which Skein has a library
_BEHIND = [os.path.join(_IDL, "skein"), os.path.join(_IDL, "corba")]  # looked at behind the user's folders
_TARGETS = {"all", "clean", "edit_cache", "help", "install", "list_install_components", "package", "preinstall", "rebuild_cache", "skein", "test"}
_FILES = {"build", "mission"}  # that stand for something else in a project
_LARGEST = 2 << 20  # bytes of a file in which an interface is looked for


_PROJECT = """# Begun by `skein new`, which adds a line for each component.
cmake_minimum_required(VERSION 3.25)
project(components LANGUAGES C CXX)

find_package(skein REQUIRED)

set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})  # what SKEIN_MODULE_PATH names
"""


class Refused(Exception):
    def __init__(self, reason, code=_REFUSED):
        super().__init__(reason)
        self.code = code


def main(words):
    """The exit code."""
    options = argparse.ArgumentParser(prog="skein-idl --component")
    options.add_argument("kind", choices=("entity", "csp", "activity"))
    options.add_argument("name")
    options.add_argument("files", nargs="*")
    options.add_argument("--folder", default="")
    options.add_argument("--implements", default="")
    options.add_argument("--operations", default="")
    options.add_argument("--needs", action="append", default=[])
    options.add_argument("--csps", action="append", default=[])
    options.add_argument("-I", dest="folders", action="append", default=[])
    arguments = options.parse_args(words)
    try:
        _Project(arguments).write()
        return 0
    except OSError as error:
        return _told(f"{error.filename or arguments.folder or '.'}: {error.strerror}; name another folder by --folder", _UNWRITTEN)
    except KeyboardInterrupt:
        return _INTERRUPTED
    except Refused as refusal:
        return _told(str(refusal), refusal.code)


def _told(reason, code):
    if reason:
        sys.stderr.write(printable(f"skein: {reason}") + "\n")
    return code


def _snake(name):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


# ---- interfaces ----------------------------------------------------------------------------------


class _Interfaces:
    """Finds interfaces by their names in IDL files."""

    def __init__(self, files, folders, project):
        self._named = files
        self._folders = folders
        self._project = project
        self._compiled = {}  # by path
        self._seen = set()  # names of interfaces in files that were looked at

    def find(self, wanted):
        """The interface, such as `survey::IPlanner`, `IDL:survey/IPlanner` or `IPlanner`."""
        name = wanted.removeprefix("IDL:").split(":1.")[0].replace("/", "::").removeprefix("::")
        if not re.fullmatch(r"\w+(::\w+)*", name):
            raise Refused(f"'{wanted}' is no name of an interface, such as survey::IPlanner", _USAGE)
        found = {}
        for paths in self._candidates():
            for path in map(os.path.abspath, paths):
                for each in self._interfaces_of(path, name.split("::")[-1]):
                    if each.idl_name == name or each.idl_name.endswith("::" + name):
                        found.setdefault(each.idl_name, (each, path))
            if found:
                break
        if name in found:
            return found[name]
        if len(found) > 1:
            raise Refused(f"'{wanted}' is several interfaces: {', '.join(sorted(found))}; write one of these")
        if not found:
            raise Refused(f"no IDL file here has an interface '{name}'{suggestion(name, self._seen - {name})}; name its file by --idl")
        return next(iter(found.values()))

    def _candidates(self):
        """Files that may declare it; those that are nearer come first."""
        for path in self._named:
            if not os.path.isfile(path):
                raise Refused(f"there is no file {path}")
        for folder in self._folders:
            if not os.access(folder, os.R_OK | os.X_OK):
                raise Refused(f"the folder {folder} cannot be read")
        beside = [path for folder in _folders_in(self._project) for path in _listed(folder)]  # other components' interfaces
        return [self._named, *map(_listed, (".", *self._folders)), beside, _listed(_NAVIGATION)]

    def _interfaces_of(self, path, name):
        """Of a file that may declare that one; others are not compiled."""
        declared = set(re.findall(r"\binterface\s+_?(\w+)", _text_of(path)))
        self._seen |= declared
        if name not in declared:
            return []
        compilation = self.compiled(path)
        if not compilation.accepted:
            raise Refused("")  # the compiler has told why
        return compilation.interfaces

    def compiled(self, path):
        if path not in self._compiled:
            self._compiled[path] = Compilation(path, [*self._folders, os.path.dirname(os.path.abspath(path)), *_BEHIND], [])
        return self._compiled[path]


def _folders_in(folder):
    return sorted(entry.path for entry in os.scandir(folder) if entry.is_dir()) if os.path.isdir(folder) else []


def _listed(folder):
    """The IDL files of a folder, without those that Skein has generated; none of one that cannot be read."""
    try:
        return sorted(entry.path for entry in os.scandir(folder)
                      if entry.name.endswith(".idl") and not entry.name.endswith(".dds.idl") and entry.name[0] != "." and entry.is_file())  # fmt: skip
    except OSError:
        return []


def _text_of(path):
    with open(path, encoding="utf-8", errors="replace", newline="") as stream:
        return stream.read(_LARGEST)


def _is_within(path, folder):
    return os.path.abspath(path).startswith(os.path.join(folder, ""))


# ---- the project ---------------------------------------------------------------------------------


class _Project:
    """The folder of a new component."""

    def __init__(self, arguments):
        self._arguments = arguments
        self._kind = arguments.kind
        self._name = arguments.name if isinstance(arguments.name, str) else "--"  # of which argparse makes a list
        self._check_arguments()
        stem = _snake(self._name)
        is_taken = stem in _TARGETS | _FILES or stem.endswith("_generated")
        self._stem = stem + "_component" if is_taken else stem
        self._project = arguments.folder or "."
        self._folder = os.path.normpath(os.path.join(self._project, self._stem))
        self._folders = [os.path.abspath(folder) for folder in arguments.folders]  # of the user's IDL, in the order of the search
        self._interfaces = _Interfaces(arguments.files, list(self._folders), self._project)
        self._declaring = []  # IDL files that declare the interfaces
        self._files = []  # the user's among them, with those that they include
        self._read = set()  # these, and what they include without declaring anything
        self._outermost = set()  # names in all of them
        self._sketch = ""
        self._implemented = self._implemented_interface()
        self._needs = self._all_found(arguments.needs)
        self._csps = self._all_found(arguments.csps)

    def _check_arguments(self):
        name = self._name
        if not re.fullmatch(r"[A-Z][A-Za-z0-9]*", name):
            proposal = "".join(part[:1].upper() + part[1:] for part in re.split(r"[^A-Za-z0-9]+", name)).lstrip("0123456789")
            raise Refused(f"'{name}' cannot be a component's class: write letters and digits, as in '{proposal or 'Watcher'}'", _USAGE)
        given = self._arguments
        if any("\udc80" <= character <= "\udcff" for character in given.operations):
            raise Refused("the operations are no UTF-8", _USAGE)
        if given.implements and given.operations:
            raise Refused("a component implements an interface that is there, or a new one: leave out --implements or --operations", _USAGE)
        if self._kind == "activity" and (given.implements or given.operations):
            raise Refused("an activity implements no interface; what does is an entity", _USAGE)
        if self._kind != "entity" and given.csps:
            raise Refused("only an entity has CSPs", _USAGE)
        if self._kind == "csp" and given.needs:
            raise Refused("a CSP needs no other services: its entity asks them, and tells it", _USAGE)

    def _implemented_interface(self):
        if self._kind == "activity":
            return None
        if self._arguments.implements:
            return self._found(self._arguments.implements)
        return self._sketched()

    def _all_found(self, names_of_interfaces):
        """Each once."""
        return list({found.idl_name: found for found in map(self._found, names_of_interfaces)}.values())

    def _found(self, name):
        interface, path = self._interfaces.find(name)
        self._declaring.append(path)
        if not _is_within(path, _NAVIGATION):
            compilation = self._interfaces.compiled(path)
            declaring, others = compilation.included_files
            self._outermost |= compilation.outermost_names
            self._read.update((path, *declaring, *others))
            self._files += [each for each in (path, *declaring) if not _is_within(each, _IDL) and each not in self._files]
        return interface

    def _include_folders(self):
        """The user's that are needed, then the one around all other IDL files."""
        users = [path for path in self._read if not _is_within(path, _IDL)]
        named = [folder for folder in self._folders if any(_is_within(path, folder) for path in users)]
        others = [os.path.dirname(path) for path in users if not any(_is_within(path, folder) for folder in named)]
        return named + ([os.path.commonpath(others)] if others else [])

    def _headers(self):
        """As skein_add_idl() names them: from the first folder that holds the file."""
        found = {self._stem + ".idl.hpp"} if self._sketch else set()
        for path in self._declaring:
            folder = next(each for each in [*self._include_folders(), _NAVIGATION] if _is_within(path, each))
            found.add(os.path.relpath(path, folder) + ".hpp")
        return found

    def _sketched(self):
        """A new interface, from its operations."""
        module = self._stem
        if module in names.KEYWORDS | names.NAMESPACE | parser.KEYWORDS | {"linux", "unix"}:
            module += "_service"
        text = self._arguments.operations.strip() or "double value();"
        operations = [line.strip() for line in (text if text[-1] in ";}/" else text + ";").splitlines()]
        body = "\n".join(f"    {line}".rstrip() for line in operations)
        self._sketch = f"module {module} {{\n  interface I{self._name} {{\n{body}\n  }};\n}};\n"
        here = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)  # so that findings name the file alone
            try:
                with open(self._stem + ".idl", "w", encoding="utf-8") as stream:
                    stream.write(self._sketch)
                compilation = self._interfaces.compiled(self._stem + ".idl")
            finally:
                os.chdir(here)
        found = [each for each in compilation.interfaces if each.idl_name == f"{module}::I{self._name}"]
        if not compilation.accepted or not found:
            raise Refused("the operations are no IDL, such as `double depth(in double length);`" if compilation.accepted else "")
        return found[0]

    # ---- what is written -------------------------------------------------------------------------

    def write(self):
        files = {
            self._stem + ".idl": self._sketch,
            self._stem + ".cpp": _Source(self._kind, self._name, self._implemented, self._needs, self._csps, self._headers(), self._outermost).text(),
            self._stem + ".xml": self._description(),
            "CMakeLists.txt": self._build(),
            "mission.xml": "" if self._kind == "csp" or self._needs or self._csps else self._mission(),
        }
        files = {name: text for name, text in files.items() if text}
        project = os.path.join(self._project, "CMakeLists.txt")
        if os.path.lexists(project) and not os.path.isfile(project):
            raise Refused(f"{project} is no file: name another folder by --folder")
        there = [name for name in files if os.path.lexists(os.path.join(self._folder, name))]
        if there:
            raise Refused(f"{os.path.join(self._folder, there[0])} is there already: remove it, or name another folder by --folder")
        made = not os.path.isdir(self._folder)
        os.makedirs(self._folder, exist_ok=True)
        written = []
        try:
            for name, text in files.items():
                path = os.path.join(self._folder, name)
                with open(path, "x", encoding="utf-8") as stream:
                    written.append(path)
                    stream.write(text)
            is_built = self._join_project(written)
        except BaseException:
            for path in written:
                os.unlink(path)
            if made:
                os.rmdir(self._folder)
            raise
        self._tell(files, is_built)

    def _join_project(self, written):
        """Adds the component to the project around it, which it begins if there is none; false if that is the user's own."""
        path = os.path.join(self._project, "CMakeLists.txt")
        if not os.path.lexists(path):
            with open(path, "x", encoding="utf-8") as stream:
                written.append(path)
                stream.write(_PROJECT)
        text = _text_of(path)
        if not text.startswith(_PROJECT):
            return False
        line = f"add_subdirectory({self._stem})"
        if line not in text.splitlines():
            with open(path, "a", encoding="utf-8") as stream:
                stream.write(("" if text.endswith("\n") else "\n") + line + "\n")
        return True

    def _description(self):
        def part(tag, inner):
            return f"  <{tag}>\n{inner}  </{tag}>\n" if inner else ""

        def type_of(interface):
            return "IDL:" + "/".join(interface.scope)

        implemented = f"    <implements>\n      <type>{type_of(self._implemented)}</type>\n    </implements>\n" if self._implemented else ""
        needs = "".join(f"    <depends>{type_of(each)}</depends>\n" for each in self._needs)
        csps = "".join(f"    <subcomponent>{type_of(each)}</subcomponent>\n" for each in self._csps)
        return (f'<component name="{self._name}">\n' + part("interfaces", implemented) + part("dependencies", needs)
                + part("subcomponents", csps) + "</component>\n")  # fmt: skip

    def _build(self):
        lines = [f"add_library({self._stem} MODULE {self._stem}.cpp)"]
        files = ([self._stem + ".idl"] if self._sketch else []) + [self._reference(path) for path in self._files]
        if files:
            needed = self._include_folders()
            folders = ([os.path.abspath(self._folder)] if self._sketch and needed else []) + needed
            includes = " INCLUDES " + " ".join(map(self._reference, folders)) if folders else ""
            lines.append(f"skein_add_idl(TARGET {self._stem} FILES {' '.join(files)}{includes})")
        navigation = "skein::navigation_idl " if any(_is_within(path, _NAVIGATION) for path in self._declaring) else ""
        return "\n".join([*lines, f"target_link_libraries({self._stem} PRIVATE {navigation}skein::skein)"]) + "\n"

    def _reference(self, path):
        """How the project names a file or folder: from its own folder, unless they share no more than the root."""
        path, folder = os.path.abspath(path), os.path.abspath(self._folder)
        common = os.path.commonpath([path, folder])
        reference = path if common == os.sep else os.path.relpath(path, folder)
        if ";" in reference:
            raise Refused(f"CMake divides the path {reference} at its ';': name other folders")
        reference = re.sub(r'([\\"$;])', r"\\\1", reference)
        return f'"{reference}"' if re.search(r"[^\w./+-]", reference) else reference

    def _mission(self):
        role = ' role="mission"' if self._kind == "activity" else ""
        return (f'<!-- A mission to try it. -->\n<mission name="{self._stem}" domain="50" system="trial" plugin="{self._stem}">\n'
                f'  <peer name="{self._stem}" component="{self._stem}.xml"{role}/>\n</mission>\n')  # fmt: skip

    def _tell(self, files, is_built):
        purposes = {".idl": "its interface: begin here", ".cpp": "what it does", ".xml": "what it provides and needs"}
        for name in files:
            purpose = "a mission to try it" if name == "mission.xml" else purposes.get(os.path.splitext(name)[1], "builds its plugin")
            print(printable(f"{os.path.join(self._folder, name):40} {purpose}"))
        print()
        if not is_built:
            print(printable(f"Add to {os.path.join(self._project, 'CMakeLists.txt')}, behind find_package(skein): add_subdirectory({self._stem})"))
            return
        build = shlex.quote(os.path.normpath(os.path.join(self._project, "build")))
        prefix = os.path.normpath(os.path.join(_IDL, "../../.."))
        found = f" -D CMAKE_PREFIX_PATH={shlex.quote(prefix)}" if _IDL.endswith("share/skein/idl") and prefix not in ("/usr", "/usr/local") else ""
        print(printable(f"cmake -S {shlex.quote(self._project)} -B {build}{found} && cmake --build {build}"))
        if "mission.xml" in files:
            print(printable(f"SKEIN_MODULE_PATH={build} skein check {shlex.quote(os.path.join(self._folder, 'mission.xml'))}"))


# ---- the source ----------------------------------------------------------------------------------


class _Source:
    """The C++ of a component."""

    def __init__(self, kind, name, implemented, needs, csps, headers, outermost):
        self._kind = kind
        self._component = name
        self._implemented = implemented
        self._needs = needs
        self._csps = csps
        self._headers = headers
        inherited = [implemented, *implemented.all_bases()] if implemented else []
        members = {operation.cpp_name for each in inherited for operation in each.operations}
        modules = {implemented.scope[0]} if implemented else set()
        # Such a name would hide the class, or be hidden by it.
        self._name = name + ("Component" if name in outermost | modules | members | names.MACROS else "")
        self._members_of_bases = members
        self._hiding = {"Proxy", "Skeleton", "Deferred", self._name} | members
        self._hiding |= {each.cpp_name for each in inherited} | {nested.scope[-1] for each in inherited for nested in each.nested}

    def _cpp(self, text):
        """Without the leading `::` of names that nothing in the class hides."""
        return re.sub(r"(?<![\w>:])::(\w+)", lambda found: found[0] if found[1] in self._hiding else found[1], text)

    def text(self):
        includes = [f'#include "{header}"' for header in sorted({*self._headers, "skein/component_registry.hpp", *self._own_headers()})]
        standard = ["#include <chrono>", ""] if self._kind == "activity" else ["#include <memory>", ""]
        body = [] if self._kind == "activity" else ["namespace {", "", *self._class(), "", "}  // namespace", ""]
        lines = [*standard, *includes, "", *body, 'extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }', "",
                 'extern "C" void skein_register_components(skein::ComponentRegistry& registry) {', *self._registration(), "}"]  # fmt: skip
        return "\n".join(lines) + "\n"

    def _own_headers(self):
        return ([] if self._kind == "csp" else ["skein/entity.hpp"]) + (["skein/head.hpp"] if self._csps else [])

    def _class(self):
        lines = [f"class {self._name} : public {self._cpp(self._implemented.cpp)} {{", " public:"]
        members = self._members()
        if members:
            first, *others = [f"{name}({value})" for _, name, value in members]
            lines += [f"  explicit {self._name}(skein::Entity& entity)", f"      : {first}" + ("," if others else " {}")]
            lines += [f"        {each}" + ("," if i + 1 < len(others) else " {}") for i, each in enumerate(others)] + [""]
        for operation in self._implemented.all_operations():
            if not operation.by_default:
                lines += self._operation(operation)
        if members:
            lines += [" private:", *self._questions(), *(f"  {self._cpp(kind)} {name};" for kind, name, _ in members)]
        if lines[-1] == "":
            lines.pop()
        return [*lines, "};"]

    def _members(self):
        taken = set(self._members_of_bases)
        members = [("skein::Head&", names.unique("head_", frozenset(), taken), "entity.head()")] if self._csps else []
        for each in self._needs:
            member = names.unique(_snake(re.sub("^I(?=[A-Z])", "", each.scope[-1])) + "_", frozenset(), taken)
            members.append((f"{each.cpp}::Proxy", member, f"entity.connect<{self._cpp(each.cpp)}>()"))
        return members

    def _operation(self, operation):
        kinds = [cpp.type_name(p.type) + "&" if p.is_out else cpp.parameter_type(p.type) for p in operation.parameters]
        given = [f"{self._cpp(kind)} /*{p.cpp_name}*/" for kind, p in zip(kinds, operation.parameters)]
        if operation.stream:
            given.append(f"skein::StreamSink<{self._cpp(cpp.type_name(operation.result))}>& /*sink*/")
        return [f"  {self._cpp(interface_template.result(operation))} {operation.cpp_name}({', '.join(given)}) override {{",
                f'    throw skein::Unavailable("{self._component}: {operation.name} is not written yet");', "  }", ""]  # fmt: skip

    def _questions(self):
        """For each managed interface how the Head has a CSP answer its first operation."""
        lines = []
        taken = {operation.cpp_name for operation in self._implemented.all_operations()}
        for interface in self._csps:
            operation = next((each for each in interface.all_operations() if _is_plain(each)), None)
            if not operation:
                continue
            name = names.unique("ask_for_" + operation.name, names.OPERATION, taken)
            result = self._cpp(cpp.type_name(operation.result))
            given = ", ".join(f"{self._cpp(cpp.parameter_type(p.type))} {p.cpp_name}" for p in operation.parameters)
            proxy = names.unique("csp", frozenset(), {p.cpp_name for p in operation.parameters})
            task = names.unique("task", frozenset(), {proxy, *(p.cpp_name for p in operation.parameters)})
            lines += [
                "  /// Has a CSP answer, which the Head chooses; `task.evaluate` may refuse its result.",
                f"  [[maybe_unused]] {result} {name}({given}) {{",
                f"    skein::Task<{self._cpp(interface.cpp)}, {result}> {task};",
                f'    {task}.request = "{operation.name}";',
                f"    {task}.run = [&]({self._cpp(interface.cpp)}::Proxy& {proxy}, skein::Duration) {{",
                f"      return {proxy}.{operation.cpp_name}({', '.join(p.cpp_name for p in operation.parameters)});",
                "    };",
                f"    return this->{self._members()[0][1]}.perform({task});",
                "  }",
                "",
            ]
        return lines

    def _registration(self):
        if self._kind == "activity":
            return self._activity()
        interface = self._cpp(self._implemented.cpp)
        skeleton = f"std::make_shared<{interface}::Skeleton>"
        if self._kind == "csp":
            return [f'  registry.add_csp<{interface}>("{self._component}", [](const skein::ParameterValues&) {{',
                    f"    return {skeleton}(std::make_shared<{self._name}>());", "  });"]  # fmt: skip
        made = f"std::make_shared<{self._name}>({'entity' if self._members() else ''})"
        entity = "skein::Entity& entity" if self._members() else "skein::Entity&"
        return [f'  registry.add_body<{interface}>("{self._component}", []({entity}, const skein::ParameterValues&) {{',
                f"    return skein::ComponentRegistry::Body{{{skeleton}({made})}};", "  });"]  # fmt: skip

    def _activity(self):
        taken = {"entity", "told_to_end", "registry"}
        proxies = [f"    [[maybe_unused]] auto {names.unique(name[:-1], frozenset(), taken)} = {value};" for _, name, value in self._members()]
        return [f'  registry.add_activity("{self._component}", [](skein::Entity& entity, const skein::ParameterValues&,',
                "                                   const std::stop_token& told_to_end) {",
                *proxies,
                "    while (!skein::await_end(entity, told_to_end, std::chrono::seconds(1))) {",
                "      // What it does each second.",
                "    }",
                "    return 0;  // the process's exit code",
                "  });"]  # fmt: skip


def _is_plain(operation):
    """Whether its result is all that it gives."""
    return bool(operation.result) and not operation.stream and all(p.direction == "in" for p in operation.parameters)
