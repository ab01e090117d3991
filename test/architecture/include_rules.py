"""Who may include whom."""

import os
import re

from source_tree import SOURCES, within

_ARCHITECTURE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "ARCHITECTURE.md")
_ROW = re.compile(r"^\| (\d[\d.]*) \|[^|]*\|([^|]*)\|", re.MULTILINE)
_PLACE = re.compile(r"`([\w/]+)`(?: (\d[\d.]*))?")


def _read_floors(text):
    """The floors of ARCHITECTURE.md's table. A folder may have a number of its own; `/x` lies beside the last one of another form."""
    found = {}
    for floor, places in _ROW.findall(text):
        beside = ""
        for place, own in _PLACE.findall(places):
            if place.startswith("/"):
                place = beside + place
            else:
                place = place.removeprefix("src/")
                beside = place.split("/")[0]
            found[place] = float(own or floor)
    return found


with open(_ARCHITECTURE, encoding="utf-8") as stream:
    # Each folder may use those below it.
    FLOORS = {**_read_floors(stream.read()), "all of the library": 8, "Asio": 0.5}
# What a user's program includes: skein/NAME.hpp, by the floor that it belongs to.
USERS_HEADERS = {
    "core": "call call_context clock error executor guid log stream",
    "idl": "describe loaned",
    "dds/port": "loopback topic_qos vendor",
    "topics": "topics",
    "brokerless_discovery": "constraint",
    "connector": "connector gather",
    "selection": "evaluation selection task",
    "entity": "component_registry entity head parameters process",
    "introspection": "inspector",
    "dynamic": "dynamic",
    "fusion": "fusion",
    "all of the library": "skein",
    "Asio": "asio",
}
# Those that skein/skein.hpp does not include: they need another library, or are that header.
BESIDE_THE_UMBRELLA = {"Asio", "fusion", "all of the library"}
# What those, and generated code, need: skein/detail/NAME.hpp.
DETAIL_HEADERS = {
    "core": "abi action box bytes call_memory channel loan_memory operation pending_reply pending_stream representation version waiting_services",
    "idl": "argument cdr codec declared_exception filled json json_codec key_hash lendable make_type_support malformed_sample plain_layout"
           " service_reference type_support union_access unknown_operation wide_text",
    "dds/port": "qos",
    "topics": "topic_ends topic_type",
    "selection": "circuit_breaker history task_run",
}
_FLOOR_OF_HEADER = {
    f"skein/{folder}{name}.hpp": floor
    for folder, headers in (("", USERS_HEADERS), ("detail/", DETAIL_HEADERS))
    for floor, names in headers.items()
    for name in names.split()
}
# For C and all languages that call it: skein/c/NAME.h.
C_HEADERS = ("api", "skein")
_FLOOR_OF_HEADER |= {f"skein/c/{name}.h": "languages/c" for name in C_HEADERS}
# Neighbours on one floor do not know each other, but for these.
NEIGHBOURS = {("mission/profile", "mission/component")}
# Headers that are generated, by the floor of their IDL; all of idl/navigation are of `navigation`.
GENERATED = {"skein/types.idl.hpp": "idl", "skein/discovery.idl.hpp": "brokerless_discovery", "skein/introspection.idl.hpp": "rpc/wire",
             "skein/inspection.idl.hpp": "entity", "skein/interface_description.idl.hpp": "languages/c", "skein/mission_status.idl.hpp": "mission/process", "skein/live_parameters.idl.hpp": "mission/process"}

# Whose headers are welcome in which folders alone. Peers and rivals without Skein, and tests that look at the vendors from
# outside, are built on the vendors' own headers.
_OUTSIDE = ["benchmarks/raw", "test/foreign", "test/dds"]
HOMES = {
    "Fast DDS": (r"(fastdds|fastrtps)/", ["src/dds/fastdds", *_OUTSIDE]),
    "Cyclone DDS": (r"dds/(dds\.h|ddsc/|ddsi/|ddsrt/)", ["src/dds/cyclonedds", "test/idl", *_OUTSIDE]),
    "Fast CDR": (r"fastcdr/", _OUTSIDE),
    "OMPL": (r"ompl/", ["src/navigation/planners"]),
    "Eigen": (r"(Eigen|eigen3|unsupported/Eigen)/", ["src/fusion", "test/fusion", "examples/reconnaissance"]),
    "pugixml": (r"pugixml", ["src/mission/xml", "src/mission/component", "test"]),
    "JSON": (r"nlohmann/", ["src/idl", "src/command", "src/view", "src/navigation/routes", "test", "benchmarks",
                             "examples/reconnaissance/report/report.cpp", "examples/reconnaissance/test"]),
    "zstd": (r"zstd\.h", ["src/recording/mcap/compression.cpp"]),
    "libdeflate": (r"libdeflate\.h", ["src/recording/mcap/compression.cpp"]),
    "Boost.Asio and Boost.Beast": (r"boost/(asio|beast)", ["src/view/web_socket.cpp"]),
    "Asio": (r"asio(\.hpp|/)", ["include/skein/asio.hpp", "test/connector"]),
    "the command line": (r"CLI/", ["src/command/line", "src/command/bench/skein_grid.cpp", "test/command", "benchmarks"]),
}
# The headers of ours that precompiled headers may bring: nobody else includes them.
PRECOMPILED = {"core/standard_library.hpp": "src/core/standard_library.hpp", "tools/precompiled.hpp": "test/tools/precompiled.hpp"}
_AREAS = re.compile(r"(?:set\(areas|list\(APPEND areas)([^)]*)\)")
_PRECOMPILES = re.compile(r"\btarget_precompile_headers\s*\(([^)]*)\)")
# What libskein must not link: modules bring it, or plugins, or libskein_mission.
LOADED_LIBRARIES = r"lib(fastrtps|fastdds|ddsc|ompl|pugixml)"


def homes(tree):
    """A foreign header outside its folder."""
    for path in tree.files(SOURCES):
        for line, included, _ in tree.includes(path):
            for library, (pattern, folders) in HOMES.items():
                if re.match(pattern, included) and not within(path, folders):
                    yield f"{path}:{line}: {included} belongs to {library}, whose headers stay in {', '.join(folders)}"


def precompiled_headers(tree):
    """A header of ours in a precompiled one.

    The compiler's cache finds a precompiled header by its preprocessed text, in which comments and macros do not show, while GCC
    tells by the whole text whether it has a header already: after an edited comment, a cached one defines everything twice.
    """
    ours = re.compile(r"skein/|.*\.idl\.hpp$")
    for path in tree.files((".txt", ".cmake")):
        for arguments in _PRECOMPILES.findall(tree.text(path)):
            for header in re.findall(r"[\w./]+\.(?:hpp|h)\b", arguments):
                if ours.match(header) or (header not in PRECOMPILED and tree.exists(f"src/{header}")):
                    yield f"{path}: precompiles {header}; precompile other people's headers alone"
    for path in PRECOMPILED.values():
        if tree.exists(path):
            for line, included, quoted in tree.includes(path):
                if quoted and included not in PRECOMPILED:
                    yield f"{path}:{line}: precompiles {included}; precompile other people's headers alone"
    for path in tree.files(SOURCES):
        for line, included, _ in tree.includes(path):
            if included in PRECOMPILED and path not in PRECOMPILED.values():
                yield f"{path}:{line}: includes {included}, which is for precompiled headers; include what is used"


def public_headers(tree):
    """A header that is installed and not named above, and one that skein.hpp lacks."""
    headers = {path.removeprefix("include/") for path in tree.files((".hpp", ".h"), "include")}
    for header in sorted(headers - set(_FLOOR_OF_HEADER)):
        yield f"include/{header}: is nowhere in USERS_HEADERS or DETAIL_HEADERS; internals lie beside their sources"
    for header in sorted(set(_FLOOR_OF_HEADER) - headers):
        yield f"include/{header}: is named as a public header and does not exist"
    umbrella = {included for _, included, _ in tree.includes("include/skein/skein.hpp")}
    for floor, names in USERS_HEADERS.items():
        for header in (f"skein/{name}.hpp" for name in names.split() if floor not in BESIDE_THE_UMBRELLA):
            if header not in umbrella:
                yield f"include/skein/skein.hpp: does not include {header}"


def floors(tree):
    """An include against the floors, or of internals by what is installed."""
    for top in ("include/skein", "src", "brokerless_discovery"):
        for path in tree.files(SOURCES, top):
            user = module_of(path)
            if user is None:
                yield f"{path}: stands on no floor; name its folder in FLOORS"
                continue
            for line, included, quoted in tree.includes(path):
                used = _module_of_include(tree, path, included, quoted)
                if used and not _may_use(user, used):
                    yield f"{path}:{line}: {user} (floor {floor_of(user):g}) includes {included} of {used} (floor {floor_of(used):g})"
                if top == "include/skein" and quoted and not included.startswith("skein/"):
                    yield f"{path}:{line}: includes {included}, which is not installed"


def test_floors(tree):
    """A folder of tests that uses a higher floor than test/CMakeLists.txt says: a change there would not run it."""
    declared = dict(re.findall(r"([\w/]+):(\d)\b", "".join(_AREAS.findall(tree.text("test/CMakeLists.txt")))))
    if not declared:
        yield "test/CMakeLists.txt: names no folder with its floor"
    for area, floor in declared.items():
        apart = [f"test/{other}" for other in declared if other.startswith(area + "/")]
        for path in tree.files(SOURCES, f"test/{area}"):
            if within(path, apart):
                continue
            for line, included, quoted in tree.includes(path):
                used = _module_of_include(tree, path, included, quoted)
                if used and int(floor_of(used)) > int(floor):
                    yield f"{path}:{line}: includes {included} of {used}; test/CMakeLists.txt puts the folder on floor {floor}"


def _may_use(user, used):
    return user == used or floor_of(used) < floor_of(user) or (user, used) in NEIGHBOURS


def floor_of(module):
    """The number of a module's floor, which may lie between two whole ones."""
    return FLOORS[module]


def module_of(path):
    """Which module a file of include, src or brokerless_discovery belongs to; None where it stands on no floor."""
    if path.startswith("include/"):
        return floor_of_header(path.removeprefix("include/"))
    parts = path.removeprefix("src/").split("/")
    for length in (2, 1):
        name = "/".join(parts[:length])
        if len(parts) > length and name in FLOORS:
            return name
    return None


def floor_of_header(included):
    """The floor of an installed header; None for another one."""
    return _FLOOR_OF_HEADER.get(included)


def _module_of_include(tree, path, included, quoted):
    if included in GENERATED:
        return GENERATED[included]
    if tree.exists(f"idl/navigation/{included.removesuffix('.hpp')}"):
        return "navigation"
    if included in _FLOOR_OF_HEADER:
        return floor_of_header(included)
    for folder in (os.path.dirname(path), "src", ""):
        found = os.path.normpath(os.path.join(folder, included))
        if quoted and tree.exists(found):
            return module_of(found)
    return None
