"""Two installations of Skein meet: meeting.py SIDE SIDE [--work FOLDER] [--only WORD].

A side is a build tree of this system, or a folder with a Debian system in which Skein is installed. Each has a network namespace of its own; a cable joins
the two. Entities of both speak to each other, on each pairing of vendors, in both directions, with each kind of message that crosses a network; then one
mission flies on both. Only root may do that. Whatever happens, processes and namespaces end with this program.
"""

import argparse
import contextlib
import json
import os
import pathlib
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time
import traceback
import xml.etree.ElementTree

SKIPPED = 77
TREE = pathlib.Path(__file__).resolve().parents[2]
VENDORS = ("fastdds", "cyclonedds")
DOMAIN = "61"
DEVICE = "skein0"
LEASE_S = 1  # the default; commands that look have it, and believe nobody who has a longer one
LONG_LEASE_S = 60  # what is seen sooner was no silence
TOGETHER_S = 90  # for what happens at once, on a machine that is busy
FLIGHT_S = 1200
LARGE = (0, 64 * 1024, 70_001, 1_200_003, 4 * 1024 * 1024)
SAID = []  # what each cell measured, for the end


class Side:
    """One installation, in a network namespace that lives as long as its `holder` does."""

    def __init__(self, folder, address):
        folder = pathlib.Path(folder).resolve()
        self.address = address
        self.environment = {}
        self.live_plugin = (folder / "lib/libpatrol_components.so").exists()  # the one of the guide, whose peer has a parameter that may change
        if (folder / "CMakeCache.txt").exists():
            self.prefix = []
            self.program, self.missions = folder / "bin/skein", TREE / "mission_profiles"
            self.environment["PYTHONPATH"] = ":".join(map(str, folder.glob("lib/python3*/dist-packages")))
            installed = self.program.exists() and self.environment["PYTHONPATH"]
        else:
            self.prefix = [str(TREE / "test/tools/in_root"), str(folder)]
            usr = next((each for each in ("usr/local", "usr") if (folder / each / "bin/skein").exists()), "")
            self.program, self.missions = pathlib.Path("/", usr, "bin/skein"), pathlib.Path("/", usr, "share/skein/mission_profiles")
            self.root = folder
            installed = usr
        if not installed:
            sys.exit(f"{folder} is neither a build tree with `skein` and its Python, nor a Debian system in which Skein is installed")
        self.holder = subprocess.Popen(["unshare", "--net", "sh", "-c", "ip link set lo up && echo up && exec cat"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        if self.holder.stdout.readline() != "up\n":
            print("skipped: network namespaces may not be made here")
            sys.exit(SKIPPED)
        self.network = ["nsenter", f"--net=/proc/{self.holder.pid}/ns/net", "--"]
        self.version = self.skein("--version").stdout.strip()
        self.name = f"{self.version} on Debian {self.run('cat', '/etc/debian_version').stdout.strip()}"

    def inside(self, *words):
        """A program of this system in the side's network."""
        subprocess.run([*self.network, *map(str, words)], check=True)

    def command(self, *words):
        return ["setpriv", "--pdeathsig", "TERM", *self.network, *self.prefix, "env", *(f"{name}={value}" for name, value in self.environment.items()), *map(str, words)]

    def run(self, *words, given=""):
        return subprocess.run(self.command(*words), input=given, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=TOGETHER_S, check=False)

    def skein(self, *words, given=""):
        return self.run(self.program, *words, given=given)

    def file(self, path):
        """One of the side's own files, as it is seen from here."""
        return pathlib.Path(*([self.root] if self.prefix else []), str(path).lstrip("/") if self.prefix else path)


def join(one, other):
    """As test/tools/network_space.cpp does."""
    one.inside("ip", "link", "add", DEVICE, "type", "veth", "peer", "name", DEVICE, "netns", other.holder.pid)
    for side in (one, other):
        side.inside("ip", "address", "add", f"{side.address}/24", "dev", DEVICE)
        side.inside("ip", "link", "set", DEVICE, "up")
    for side in (one, other):  # the kernel sees a carrier a little later
        side.inside("timeout", "20", "sh", "-c", f"until ip link show {DEVICE} | grep -q LOWER_UP; do :; done")


class Peer:
    """An entity of a side, which does as it is told: see peer.py."""

    def __init__(self, side, others, name, vendor, log, lease=LEASE_S):
        self.name, self.vendor, self.side = name, vendor, side
        self.log = open(log, "w", encoding="utf-8")
        self.process = subprocess.Popen(side.command("/usr/bin/python3", "-B", TREE / "test/releases/peer.py", name, vendor, DEVICE, lease, side.address, others.address),
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.log, text=True)  # fmt: skip
        self.answers = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()
        self.version = self._answer("start")

    def _read(self):
        for line in self.process.stdout:
            self.answers.put(line)
        self.answers.put("")

    def _answer(self, what):
        try:
            line = self.answers.get(timeout=TOGETHER_S)
        except queue.Empty:
            raise AssertionError(f"{self.name} has not answered within {TOGETHER_S} s: {what}") from None
        if not line:
            raise AssertionError(f"{self.name} has ended: {what}")
        answer = json.loads(line)
        if "wrong" in answer:
            raise AssertionError(f"{self.name}: {what}: {answer['wrong']}")
        return answer["value"]

    def tell(self, name, *arguments):
        self.process.stdin.write(json.dumps([name, *arguments]) + "\n")
        self.process.stdin.flush()
        return lambda: self._answer(name)

    def ask(self, name, *arguments):
        return self.tell(name, *arguments)()

    def kill(self):
        self.process.kill()
        self.process.wait()

    def close(self):
        with contextlib.suppress(OSError):
            self.process.stdin.close()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.kill()
        self.log.close()


def eventually(what, condition):
    end = time.monotonic() + TOGETHER_S
    while not (result := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"not within {TOGETHER_S} s: {what}")
    return result


class Cell:
    """A server of one side and a client of the other, each by one vendor."""

    def __init__(self, server_side, client_side, server_vendor, client_vendor, work):
        self.sides = server_side, client_side
        self.vendors = server_vendor, client_vendor
        self.work = work
        self.measured = {}

    def __enter__(self):
        self.stack = contextlib.ExitStack()
        server_side, client_side = self.sides
        self.server = self.peer(server_side, "server", self.vendors[0])
        self.client = self.peer(client_side, "client", self.vendors[1])
        return self

    def __exit__(self, *_):
        self.stack.close()

    def peer(self, side, name, vendor, **options):
        other = self.sides[0] if side is self.sides[1] else self.sides[1]
        peer = Peer(side, other, name, vendor, self.work / f"{name}.log", **options)
        self.stack.callback(peer.close)
        return peer

    def options(self, side):
        """The options by which a command joins the domain, by its side's vendor."""
        vendor = self.vendors[0] if side is self.sides[0] else self.vendors[1]
        return ("--domain", DOMAIN, "--vendor", vendor, "--interface", DEVICE, "--peers", ",".join(each.address for each in self.sides))

    def look(self, side, command, *words, code=0, given=""):
        """What a command that looks at the domain prints."""
        done = side.skein(*command.split(), *words, *self.options(side), given=given)
        if done.returncode != code:
            raise AssertionError(f"`skein {command} {' '.join(map(str, words))}` on {side.name} ended with {done.returncode}: {done.stderr}{done.stdout}")
        return done.stdout + done.stderr if code else done.stdout

    def watch(self, side, command, *words):
        """One that looks until it is stopped."""
        return self.stack.enter_context(Watched(side.command(side.program, command, *words, *self.options(side)), self.work / f"{command}.log"))

    # Each function is a part of the conversation.

    def they_meet(self):
        server, client = self.server, self.client
        server.ask("provide")
        server.ask("publish")
        client.ask("provide_echo")
        told = client.ask("calls")
        assert told == f"of {server.version}", told
        for side in self.sides:
            peers = json.loads(self.look(side, "peers", "--json"))
            by_name = {each["name"]: each for each in peers}
            for peer in (server, client):
                found = by_name[f"port/{peer.name}"]
                assert (found["vendor"], found["answers"], found["process"]["version"]) == (peer.vendor, True, peer.version), found
            services = {each["service"] for each in by_name["port/server"]["services"]}
            assert services == {"quay/IBerth", "quay/IStore", "quay/IEcho", "sea/Buoy", "sea/Mast"}, peers

    def calls_carry(self):
        for size in LARGE:
            self.client.ask("carries", size)
        for side in self.sides:
            for size in LARGE[:4]:
                cargo = [number % 251 for number in range(size)]
                told = self.look(side, "call", "IBerth", "mirror", "-", "--within", f"{TOGETHER_S}s", "--json", given=json.dumps({"cargo": cargo}))
                assert json.loads(told) == cargo, f"`skein call` on {side.name} with {size} octets"
        for part in ("calls_at_once", "streams", "passes_a_deadline", "cancels", "carries_what_grows", "calls_a_grown_version"):
            self.client.ask(part)

    def errors_cross(self):
        self.client.ask("is_refused_by_another_version")
        self.client.ask("finds_nothing_of_another_name")
        self.client.ask("is_refused_in_a_circle", "server")
        for side in self.sides:
            said = self.look(side, "call", "IBirth", "heard", "--wait", "2s", code=69)
            assert "IBerth" in said, said

    def selections_cross(self):
        server, client = self.server, self.client
        client.ask("performs_by_a_csp")
        server.ask("provide_tug", "tug-1")
        server.ask("provide_tug", "tug-2")
        client.ask("chooses", "tug-1", "tug-2")
        server.ask("provide_tug", "tug-3", 1, 4)  # one thread, and a queue of four
        client.ask("overloads", "tug-3")
        server.ask("withdraw_tug", "tug-3")

    def topics_cross(self):
        self.client.ask("subscribes")
        published = self.server.tell("publish_entries", 500)
        self.client.ask("receives_entries", 500)
        published()
        here, there = self.sides[1], self.sides[0]
        assert self.look(here, "echo", "wind", "--count", "3", "--json").count("\n") == 3
        received = self.client.tell("receives_entries", 1)
        self.look(here, "publish", "entries", '{"place": "pier", "number": 0, "depth_m": 0}')
        received()
        for side in (here, there):
            topics = {each["name"] for each in json.loads(self.look(side, "topics", "--json"))}
            assert {"tide", "swell", "wind", "rudder", "entries"} <= topics, topics

    def each_looks_into_the_other(self):
        for side in self.sides:
            described = self.look(side, "describe", "quay::IBerth")
            assert "@stream unsigned long bollards(in unsigned long count);" in described and "raises (Full)" in described, described
            assert "@appendable" in self.look(side, "describe", "entries")
            answer = json.loads(self.look(side, "call", "IBerth", "moor", '{"ship": "Lyra", "side": "Port", "crates": 2}', "--json"))
            assert "Lyra at Port" in json.dumps(answer), answer
            full = self.look(side, "call", "IBerth", "moor", '{"ship": "Lyra", "side": "Port", "crates": -1}', code=1)
            assert "no room for Lyra" in full, full
            statistics = json.loads(self.look(side, "services", "--statistics", "--json", "--wait", "2.5s"))
            berth = next(each for each in statistics if each["service"] == "quay/IBerth")
            assert any(each["name"] == "mirror" and each["answered"] >= 105 for each in berth["operations"]), berth
            assert any(each["client"] == "port/client" and each["transport"] == "DDS" for each in berth["connections"]), berth
            lines = self.watch(side, "log", "--json")
            calls = self.watch(side, "calls", "--json")
            decisions = self.watch(side, "decisions", "--json")
            record = self.watch(side, "record", "--output", self.work / "recorded.mcap")

            def speak():
                self.client.ask("carries", 2000)
                self.client.ask("performs_by_a_csp")

            for what, watched, texts in (("log", lines, ["Berth.moor has failed"]), ("calls", calls, ["port/server", "port/client", "mirror"]),
                                         ("decisions", decisions, ["port/client", "Grand"])):  # fmt: skip
                eventually(f"`skein {what}` on {side.name} shows {texts}", lambda watched=watched, texts=texts: speak() or all(text in watched.text() for text in texts))
            for watched in (lines, calls, decisions, record):
                watched.stop()
            recorded = side.skein("info", self.work / "recorded.mcap").stdout
            assert "mirror" in recorded or "IBerth" in recorded, recorded
            assert "wind" in recorded, recorded

    def parameters_cross(self):
        """Those of a peer in C++: what is installed has none with such parameters."""
        side, other = self.sides
        if not side.live_plugin:
            print(f"    not asked for its parameters: {side.name}, which has no plugin patrol_components")
            return
        guide, profile = TREE / "test/guide", self.work / "patrol.xml"
        profile.write_text(f"<mission name='patrol' domain='{DOMAIN}' system='port' vendor='{self.vendors[0]}' plugin='patrol_components' interface='{DEVICE}' "
                           f"peers='{side.address} {other.address}' dictionary='{guide}/dictionary.xml'><peer name='beacon' component='{guide}/beacon.xml'>"
                           "<parameter name='Period' value='0.1 s'/></peer></mission>", encoding="utf-8")  # fmt: skip
        launch = self.stack.enter_context(Watched(side.command(side.program, "launch", "--no-log", "--verbose", profile), self.work / "launch.log"))
        eventually("the beacon is ready", lambda: "beacon: ready" in launch.text())
        assert "Period" in self.look(other, "param list")
        self.look(other, "param set", "beacon", "Period", "200 ms")
        for each in self.sides:
            assert "200" in self.look(each, "param get", "beacon", "Period")
        self.look(other, "param set", "beacon", "Period", "20 s", code=1)
        assert launch.stop() == 128 + signal.SIGTERM, launch.text()

    def deaths_are_seen(self):
        mortal = self.peer(self.sides[0], "mortal", self.vendors[0])
        mortal.ask("provide_tug", "tug-3")
        self.client.ask("begins_a_long_tow", "tug-3")
        mortal.kill()
        self.measured["killed"] = self.client.ask("loses_it")
        self.client.ask("waits_for_tugs", "tug-1", "tug-2")

    def leaving_is_seen(self):
        """By those who are patient, so that no silence can have told them."""
        leaver, stayer = (self.peer(self.sides[0], name, self.vendors[0], lease=LONG_LEASE_S) for name in ("leaver", "stayer"))
        patient = self.peer(self.sides[1], "patient", self.vendors[1], lease=LONG_LEASE_S)
        leaver.ask("provide_tug", "tug-3")
        leaver.ask("provide_tug", "tug-4")
        stayer.ask("provide_tug", "tug-5")
        patient.ask("waits_for_tugs", "tug-1", "tug-2", "tug-3", "tug-4", "tug-5")
        leaver.ask("withdraw_tug", "tug-4")
        self.measured["withdrawn"] = patient.ask("waits_for_tugs", "tug-1", "tug-2", "tug-3", "tug-5")
        patient.ask("keeps_calling", "tug-3")
        assert leaver.ask("drain") is True
        self.measured["calls while it left"] = patient.ask("calls_elsewhere", "tug-3")
        leaver.close()
        self.measured["left"] = patient.ask("waits_for_tugs", "tug-1", "tug-2", "tug-5")
        assert self.measured["withdrawn"] + self.measured["left"] < LONG_LEASE_S / 2, self.measured


CONVERSATION = ("they_meet", "calls_carry", "errors_cross", "selections_cross", "topics_cross", "each_looks_into_the_other", "parameters_cross", "deaths_are_seen", "leaving_is_seen")


class Watched:
    """A command that runs until it is stopped; what it printed is in a file."""

    def __init__(self, words, log):
        self.log = log
        with open(log, "w", encoding="utf-8") as output:
            self.process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    def text(self):
        return self.log.read_text(encoding="utf-8")

    def stop(self):
        """Not by SIGINT, which a shell has ignored by what it runs in the background."""
        self.process.terminate()
        return self.process.wait(TOGETHER_S)


def speak(sides, work, only):
    for vendors in [(one, other) for one in VENDORS for other in VENDORS]:
        for server, client in (sides, sides[::-1]):
            place = "A" if server is sides[0] else "B"
            name = f"server on {place} by {vendors[0]}, client by {vendors[1]}"
            if only not in name:
                continue
            folder = work / f"{place}_{vendors[0]}_{vendors[1]}"
            folder.mkdir()
            began = time.monotonic()
            with Cell(server, client, *vendors, folder) as cell:
                for part in CONVERSATION:
                    part_began = time.monotonic()
                    try:
                        getattr(cell, part)()
                    except (AssertionError, subprocess.TimeoutExpired) as failure:
                        traceback.print_exc()
                        sys.exit(f"{name}: {part}: {failure}\nThe logs of both are in {folder}")
                    print(f"  {name}: {part} {time.monotonic() - part_began:.1f} s", flush=True)
            said = ", ".join(f"{what} {value:.1f} s" if isinstance(value, float) else f"{what} {value}" for what, value in cell.measured.items())
            SAID.append(f"{name}: {time.monotonic() - began:.0f} s; {said}")


def split_mission(side, sides, folder):
    """The side's own two_aircraft.xml for two hosts, `first` with the first aircraft and the ground, and `second`."""
    original = side.missions / "reconnaissance/two_aircraft.xml"
    mission = xml.etree.ElementTree.parse(side.file(original)).getroot()
    mission.set("interface", DEVICE)
    mission.set("peers", " ".join(each.address for each in sides))
    for name in ("component", "dictionary"):
        for element in mission.iter():
            if name in element.attrib:
                element.set(name, os.path.normpath(original.parent / element.get(name)))
    for peer in mission.iter("peer"):
        peer.set("host", {"uav-${instance}": "host-${instance}", "uav-2": "host-2"}.get(peer.get("system"), "host-1"))
    profile = folder / "two_aircraft.xml"
    profile.write_text(xml.etree.ElementTree.tostring(mission, encoding="unicode"), encoding="utf-8")
    return profile


def sees_all(side, profile, host):
    """Whether all entities of both hosts answer to a command of this side."""
    expected = set()
    for peer in xml.etree.ElementTree.parse(profile).iter("peer"):
        for instance in map(str, range(1, int(peer.get("count", "0")) + 1)):
            expected.add(f"{peer.get('system').replace('${instance}', instance)}/{peer.get('name')}-{instance}")
        if "count" not in peer.attrib:
            expected.add(f"{peer.get('system')}/{peer.get('name')}")
    done = side.skein("peers", "--json", "--profile", profile, "--host", host)
    return done.returncode == 0 and expected <= {each["name"] for each in json.loads(done.stdout) if each["answers"]}


def fly(sides, work, only):
    for first, second in (sides, sides[::-1]):
        place = "A" if first is sides[0] else "B"
        name = f"two aircraft, the first and the ground on {place}"
        if only not in name:
            continue
        began = time.monotonic()
        with contextlib.ExitStack() as stack:
            launchers = []
            parts = []
            for host, side in (("host-1", first), ("host-2", second)):
                own = work / f"flight_{place}_{host}"
                own.mkdir()
                parts.append((side, split_mission(side, sides, own), host))
                words = side.command("env", f"--chdir={own}", side.program, "launch", parts[-1][1], "--verbose", "--no-log", "--host", host)
                launchers.append(stack.enter_context(Watched(words, own / "launch.log")))
            judge, other = launchers
            for part in parts:
                eventually(f"{part[0].name} sees all entities of the mission", lambda part=part: sees_all(*part) or any(each.process.poll() is not None for each in launchers))
            judged = judge.process.wait(FLIGHT_S)
            other_still_flew = other.process.poll() is None
            left = other.stop()
        report_file = parts[0][1].with_suffix(".json")
        report = json.loads(report_file.read_text(encoding="utf-8")) if report_file.exists() else {}
        if (judged, other_still_flew, left, report.get("verdict")) != (0, True, 128 + signal.SIGTERM, "passed"):
            sys.exit(f"{judge.text()}{other.text()}{name}: the launchers ended with {judged} and {left}; {report.get('verdict')}: {report.get('reason')}")
        SAID.append(f"{name}: {time.monotonic() - began:.0f} s; passed, {len(report['checks'])} checks")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("sides", nargs=2, metavar="SIDE")
    arguments.add_argument("--work", required=True, help="a folder below build/ of this tree, for logs and recordings; what it holds is removed")
    arguments.add_argument("--only", default="", help="cells with this in their name")
    given = arguments.parse_args()
    if os.geteuid() != 0:
        print("skipped: only root may join two network namespaces")
        sys.exit(SKIPPED)
    work = pathlib.Path(given.work).resolve()
    if TREE / "build" not in work.parents:
        sys.exit(f"--work {work} is not below {TREE / 'build'}: both sides have to see it, and it is emptied")
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    sides = [Side(folder, f"10.61.0.{number}") for number, folder in enumerate(given.sides, 1)]
    join(*sides)
    for place, side in zip("AB", sides):
        print(f"{place}: {side.name}", flush=True)
    speak(sides, work, given.only)
    fly(sides, work, given.only)
    print("\n".join(SAID) or sys.exit(f"no cell has '{given.only}' in its name"))


main()
