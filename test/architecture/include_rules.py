"""Who may include whom."""

import os
import re

from source_tree import SOURCES, within

# The floors of ARCHITECTURE.md. Each may use those below it.
FLOORS = {
    "core": 0,
    "idl": 1,
    "dds": 2,
    "dds/loopback": 2.5,
    "dds/fastdds": 2.5,
    "dds/cyclonedds": 2.5,
    "rpc": 3,
    "topics": 3,
    "brokerless_discovery": 4,
    "connector": 5,
    "entity": 6,
    "profile": 7,
    "launch": 7,
    "fusion": 7,
    "navigation": 7,
    "navigation/grid": 1.5,
    "navigation/components": 7.5,
    "skein": 8,
    "asio.hpp": 0.5,
}
# Neighbours on one floor do not know each other, but for these.
NEIGHBOURS = {("launch", "profile")}
# Headers that are generated, by the floor of their IDL.
GENERATED = {
    "skein/discovery.idl.hpp": "brokerless_discovery",
    "skein/introspection.idl.hpp": "rpc",
    "navigator.idl.hpp": "navigation",
    "flight_controller.idl.hpp": "navigation",
    "ad_manager.idl.hpp": "navigation",
}

# Whose headers are welcome in which folders alone. Peers and rivals without Skein, and tests that look at the vendors from
# outside, are built on the vendors' own headers.
_OUTSIDE = ["benchmarks/raw", "test/foreign", "test/conformance"]
HOMES = {
    "Fast DDS": (r"(fastdds|fastrtps)/", ["src/dds/fastdds", *_OUTSIDE]),
    "Cyclone DDS": (r"dds/(dds\.h|ddsc/|ddsi/|ddsrt/)", ["src/dds/cyclonedds", "test/idl", *_OUTSIDE]),
    "Fast CDR": (r"fastcdr/", ["src/idl", "test/idl", *_OUTSIDE]),
    "OMPL": (r"ompl/", ["src/navigation"]),
    "Eigen": (r"(Eigen|eigen3|unsupported/Eigen)/", ["src/fusion", "test/fusion"]),
    "pugixml": (r"pugixml", ["src/profile", "test"]),
    "JSON": (r"nlohmann/", ["src/idl", "src/skein", "test", "benchmarks"]),
    "Asio": (r"asio(\.hpp|/)", ["include/skein/asio.hpp", "test/connector"]),
    "the command line": (r"CLI/", ["src/skein", "benchmarks", "examples"]),
}


def homes(tree):
    """A foreign header outside its folder."""
    for path in tree.files(SOURCES):
        for line, included, _ in tree.includes(path):
            for library, (pattern, folders) in HOMES.items():
                if re.match(pattern, included) and not within(path, folders):
                    yield f"{path}:{line}: {included} belongs to {library}, whose headers stay in {', '.join(folders)}"


def floors(tree):
    """An include against the floors."""
    for top in ("include/skein", "src", "brokerless_discovery"):
        for path in tree.files(SOURCES, top):
            user = _module(path)
            if user is None:
                yield f"{path}: stands on no floor; name its folder in FLOORS"
                continue
            for line, included, quoted in tree.includes(path):
                used = _module_of_include(tree, path, included, quoted)
                if used and not _may_use(user, used):
                    yield f"{path}:{line}: {user} (floor {FLOORS[user]}) includes {included} of {used} (floor {FLOORS[used]})"


def _may_use(user, used):
    return user == used or FLOORS[used] < FLOORS[user] or (user, used) in NEIGHBOURS


def _module(path):
    for prefix in ("include/skein/", "src/"):
        if path.startswith(prefix):
            path = path[len(prefix):]
    parts = path.split("/")
    for length in (2, 1):
        name = "/".join(parts[:length])
        if (len(parts) > length or name.endswith(".hpp")) and name in FLOORS:
            return name
    return None


def _module_of_include(tree, path, included, quoted):
    if included in GENERATED:
        return GENERATED[included]
    if included.startswith("skein/"):
        return _module("include/" + included)
    beside = os.path.normpath(os.path.join(os.path.dirname(path), included))
    return _module(beside) if quoted and tree.exists(beside) else None
