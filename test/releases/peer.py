"""An entity of one release, told by lines on its standard input what to do: peer.py NAME VENDOR INTERFACE LEASE HOST...

It answers each line by one of JSON: {"value": …}, or {"wrong": …}. The functions of Peer, by their names, are what it can be told, with arguments of JSON.
See meeting.py. Releases that are out run this file, too: it uses nothing that Python's `skein` of version 0.1.0 lacks.
"""

import concurrent.futures
import json
import logging
import pathlib
import sys
import threading
import time
import traceback

import skein

HERE = pathlib.Path(__file__).parent
quay = skein.load(str(HERE / "quay.idl")).quay
TOGETHER_S = 40  # for what happens at once, on a machine that is busy


def sea(version):
    """The types that grow, as the tests of versions have them."""
    return skein.load(str(HERE.parent / f"versions/sea_{version}.idl")).sea


def eventually(condition):
    """The first result that counts."""
    end = time.monotonic() + TOGETHER_S
    while not (result := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"it did not come true within {TOGETHER_S} s")
        threading.Event().wait(0.01)
    return result


def expect(found, wanted):
    if found != wanted:
        raise AssertionError(f"{shortened(found)} instead of {shortened(wanted)}")


def shortened(value):
    text = repr(value)
    return text if len(text) < 300 else f"{text[:300]}… ({len(text)} characters)"


def raised(kind, text, function, *arguments):
    """The exception, which must be of that kind and say that."""
    try:
        result = function(*arguments)
    except kind as error:
        if text not in str(error):
            raise AssertionError(f"{type(error).__name__} does not say '{text}', but: {error}") from error
        return error
    raise AssertionError(f"no {kind.__name__}, but {shortened(result)}")


def wait_unless_cancelled(ms):
    """Whether the call that this thread answers was cancelled within this time."""
    cancelled = threading.Event()
    skein.current_call().on_cancel(cancelled.set)
    return cancelled.wait(ms / 1000)


class Berth(quay.IBerth):
    def __init__(self):
        self.whistled = ""
        self.begun_count = self.cancelled_count = 0

    def moor(self, ship, side, crates):
        if crates < 0:
            raise quay.Full(f"no room for {ship}", 12)
        if crates == 0:
            raise ZeroDivisionError("a mistake of the service")
        return f"{ship} at {side.name}", crates + 1, 0.1 * crates

    def mirror(self, cargo):
        return cargo

    def bollards(self, count):
        return range(count)

    def whistle(self, ship):
        self.whistled += ship

    def heard(self):
        return self.whistled

    def after(self, ms):
        self.begun_count += 1
        if wait_unless_cancelled(ms):
            self.cancelled_count += 1
        return ms

    def begun(self):
        return self.begun_count

    def cancelled(self):
        return self.cancelled_count

    def get_harbour(self):
        return "of " + skein.__version__


class Store(quay.IStore):
    def sort(self, manifest):
        manifest.entries = sorted(manifest.entries, key=lambda entry: entry.place)
        return manifest


class Tug(quay.ITug):
    def __init__(self, name):
        self._name = name

    def name(self):
        return self._name

    def tow(self, ms):
        wait_unless_cancelled(ms)
        return ms


class Echo(quay.IEcho):
    def __init__(self, entity, name):
        self._entity, self._name = entity, name

    def shout(self, back_to):
        return self._entity.connect(quay.IEcho, name=back_to).shout(self._name)


class Pilot(quay.IPilot):
    def depth_m(self, ship):
        return float(len(ship))


class Peer:
    def __init__(self, name, vendor, interface, lease, *hosts):
        self.name = name
        self.entity = skein.Entity(name, system="port", vendor=vendor, domain=61, network=[interface], peers=hosts, lease=float(lease))
        self.ended = threading.Event()
        self.often = None
        self.provided = {}
        self.kept = []  # publishers and subscriptions
        self.proxies = {}

    def close(self):
        self.ended.set()
        if self.often:
            self.often.join()
        self.entity.close()

    # What one provides.

    def provide(self):
        new = sea(2)

        class Buoy(new.Buoy):
            def higher(self, swell, others, tide):
                if not others:
                    raise new.Adrift(new.Swell(swell.height_m, 8, "last"))
                tide.moons *= 2
                return new.Swell(others[0].height_m, 7, "higher"), tide

            def weather(self, storm):
                return new.Weather(1, new.Swell(3.5, 7)) if not storm else new.Weather(2, new.Gust(30))

            def waves(self, count):
                return (new.Swell(float(i), 5, "wave") for i in range(count))

        class Mast(new.Mast):
            def height_m(self):
                return 12

            def paint(self, with_, layers):
                pass

        self.entity.provide(Berth(), threads=4)
        self.entity.provide(Store())
        self.entity.provide(Buoy())
        self.entity.provide(Mast())
        self.entity.provide(Pilot(), csp="Grand", owner="port/client", attributes={"quality": 0.9})
        self.provide_echo()

    def provide_echo(self):
        self.entity.provide(Echo(self.entity, self.name))

    def provide_tug(self, name, threads=4, queue=0):
        self.provided[name] = self.entity.provide(Tug(name), attributes={"number": name[-1]}, threads=threads, queue=queue)

    def withdraw_tug(self, name):
        self.provided.pop(name).close()

    def drain(self):
        return self.entity.drain(TOGETHER_S)

    def publish(self):
        """What holds is published once, measurements and set-points as long as the peer lives, events when they are asked for."""
        new = sea(2)
        state = self.entity.publisher(quay.Tide, "tide", profile=skein.Profile.STATE)
        for place in ("north", "south"):
            state.publish(quay.Tide(place, 1.5, quay.Side.Starboard))
        grown = self.entity.publisher(new.Swell, "swell", profile=skein.Profile.STATE)
        grown.publish(new.Swell(2.5, 6, "far"))
        wind = self.entity.publisher(quay.Entry, "wind", profile=skein.Profile.SENSOR)
        rudder = self.entity.publisher(quay.Entry, "rudder", profile=skein.Profile.COMMAND, strength=2)
        self.events = self.entity.publisher(quay.Entry, "entries")
        self.kept += [state, grown, wind, rudder, self.events]

        def often():
            number = 0
            while not self.ended.wait(0.02):
                wind.publish(quay.Entry("mole", number))
                rudder.publish(quay.Entry("ferry", number, 0.5))
                number += 1

        self.often = threading.Thread(target=often)
        self.often.start()

    def publish_entries(self, count):
        eventually(lambda: self.events.subscribers)
        for number in range(count):
            self.events.publish(quay.Entry("pier", number, number / 4))
        if not self.events.wait_for_acknowledgments(TOGETHER_S):
            raise AssertionError("they were not acknowledged")

    # What the other one finds.

    def connect(self, interface, **choice):
        if interface not in self.proxies:
            self.proxies[interface] = self.entity.connect(interface, timeout=TOGETHER_S, **choice)
        return self.proxies[interface].within(TOGETHER_S)

    def calls(self):
        berth = self.connect(quay.IBerth)
        mooring, crates, at_m = berth.moor("Vega", quay.Side.Starboard, 4)
        expect((mooring, crates, at_m), ("Vega at Starboard", 5, 0.4))
        full = raised(quay.Full, "", berth.moor, "Vega", quay.Side.Port, -1)
        expect((full.why, full.berths), ("no room for Vega", 12))
        raised(skein.Internal, "a mistake of the service", berth.moor, "Vega", quay.Side.Port, 0)
        berth.whistle("Vega")
        expect(eventually(berth.heard), "Vega")
        return berth.get_harbour()

    def carries(self, size):
        cargo = bytes(number * number % 251 for number in range(997)) * (size // 997 + 1)
        expect(bytes(self.connect(quay.IBerth).mirror(cargo[:size])), cargo[:size])

    def calls_at_once(self):
        berth = self.connect(quay.IBerth)
        calls = [berth.asynchronous.mirror(bytes([number]) * 3000) for number in range(100)]
        expect([bytes(call.result()) for call in calls], [bytes([number]) * 3000 for number in range(100)])

    def streams(self):
        expect(list(self.connect(quay.IBerth).bollards(3000)), list(range(3000)))

    def passes_a_deadline(self):
        raised(skein.TimedOut, "", self.connect(quay.IBerth).within(0.2).after, 60_000)

    def cancels(self):
        """The service is told, as it was of the call whose deadline passed."""
        berth = self.connect(quay.IBerth)
        eventually(lambda: berth.cancelled() == berth.begun() == 1)
        call = berth.asynchronous.after(60_000)
        eventually(lambda: berth.begun() == 2)
        call.cancel()
        eventually(lambda: berth.cancelled() == 2)

    def carries_what_grows(self):
        entries = [quay.Entry("b", 2, 0.5), quay.Entry("a", 1)]
        sorted_there = self.connect(quay.IStore).sort(quay.Manifest("Vega", list(entries), {"rum": 3}))
        expect(sorted_there, quay.Manifest("Vega", entries[::-1], {"rum": 3}))

    def calls_a_grown_version(self):
        old = sea(1)
        buoy = self.connect(old.Buoy)
        higher, tide = buoy.higher(old.Swell(1), [old.Swell(2)], old.Tide(1, 2))
        expect((higher, tide), (old.Swell(2), old.Tide(1, 0)))
        expect(buoy.weather(False), old.Weather(1, old.Swell(3.5)))
        expect([wave.height_m for wave in buoy.waves(20)], [float(i) for i in range(20)])
        expect(raised(old.Adrift, "", buoy.higher, old.Swell(6), [], old.Tide(1, 2)).last, old.Swell(6))

    def is_refused_by_another_version(self):
        raised(skein.Unavailable, "another version", lambda: self.entity.connect(sea(1).Mast, timeout=3))

    def finds_nothing_of_another_name(self):
        raised(skein.Unavailable, "quay/IBerth", lambda: self.entity.connect(quay.IBerth, name="quay::IBirth", timeout=1))

    def is_refused_in_a_circle(self, other):
        raised(skein.Unavailable, "would wait for itself", self.entity.connect(quay.IEcho, name=other, timeout=TOGETHER_S).within(TOGETHER_S).shout, self.name)

    def performs_by_a_csp(self):
        def perform():
            try:
                return self.entity.perform(quay.IPilot, "depth_m", "Vega", request="depth").result
            except skein.Unavailable:
                return None

        expect(eventually(perform), 4.0)

    def tug(self, name):
        return self.entity.connect(quay.ITug, where=f"number == {name[-1]}", timeout=TOGETHER_S).within(TOGETHER_S)

    def chooses(self, *names):
        """By attributes; then the less loaded of two, whichever that is."""
        raised(skein.Unavailable, "number", lambda: self.entity.connect(quay.ITug, where="number >= 7", timeout=0.5))
        for busy, idle in (names, names[::-1]):
            expect(self.tug(busy).name(), busy)
            tows = [self.tug(busy).asynchronous.tow(60_000) for _ in range(3)]
            eventually(lambda idle=idle: self.entity.connect(quay.ITug).name() == idle)
            for tow in tows:
                tow.cancel()

    def overloads(self, name):
        """More than its queue takes."""
        tug = self.tug(name)
        tows = [tug.asynchronous.tow(50) for _ in range(20)]
        failed = [call.exception() for call in tows]
        wrong = [error for error in failed if error and not isinstance(error, skein.Overloaded)]
        if wrong or not any(failed) or all(failed):
            raise AssertionError(f"of 20 calls {sum(1 for each in failed if each)} were refused; {wrong[:1]}")

    def waits_for_tugs(self, *names):
        """Until no others can be connected to."""
        def known(name):
            try:
                self.entity.connect(quay.ITug, where=f"number == {name[-1]}", timeout=0.01)
                return True
            except skein.Unavailable:
                return False

        began = time.monotonic()
        eventually(lambda: [name for name in (f"tug-{number}" for number in range(1, 6)) if known(name)] == list(names))
        return time.monotonic() - began

    def keeps_calling(self, name):
        """Of providers that come equally, the first by its entity's name is taken, and, while it leaves, the next one."""
        tug = self.entity.connect(quay.ITug, where=f"number >= {name[-1]}", timeout=TOGETHER_S).within(TOGETHER_S)
        expect(tug.name(), name)
        self.calling, self.names = True, []

        def call():
            while self.calling:
                self.names.append(tug.name())

        self.caller = concurrent.futures.ThreadPoolExecutor(1).submit(call)
        eventually(lambda: self.caller.done() or len(self.names) > 20)

    def calls_elsewhere(self, before):
        eventually(lambda: self.caller.done() or self.names[-1] != before)
        self.calling = False
        self.caller.result(TOGETHER_S)
        return len(self.names)

    def begins_a_long_tow(self, name):
        tug = self.tug(name)
        expect(tug.name(), name)
        self.tow = tug.asynchronous.tow(600_000)

    def loses_it(self):
        began = time.monotonic()
        raised(skein.Disconnected, "", self.tow.result)
        return time.monotonic() - began

    def subscribes(self):
        old = sea(1)
        self.entries = self.entity.subscribe(quay.Entry, "entries")
        tides = self.entity.subscribe(quay.Tide, "tide", profile=skein.Profile.STATE)
        expect(sorted((next(tides).place, next(tides).place)), ["north", "south"])
        expect(next(self.entity.subscribe(old.Swell, "swell", profile=skein.Profile.STATE)), old.Swell(2.5))
        for topic, profile in (("wind", skein.Profile.SENSOR), ("rudder", skein.Profile.COMMAND)):
            values = self.entity.subscribe(quay.Entry, topic, profile=profile)
            numbers = [next(values).number for _ in range(20)]
            expect(numbers, sorted(set(numbers)))

    def receives_entries(self, count):
        expect([next(self.entries) for _ in range(count)], [quay.Entry("pier", number, number / 4) for number in range(count)])


def main():
    logging.getLogger().addHandler(skein.LogHandler())
    peer = Peer(*sys.argv[1:])
    print(json.dumps({"value": skein.__version__}), flush=True)
    for line in sys.stdin:
        name, *arguments = json.loads(line)
        try:
            answer = {"value": getattr(peer, name)(*arguments)}
        except Exception:
            answer = {"wrong": traceback.format_exc()}
        print(json.dumps(answer), flush=True)
    peer.close()


main()
