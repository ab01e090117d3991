"""One side of the table of languages, in Python: peer.py VENDOR SHARED_MEMORY provide|check. See table.py."""

import asyncio
import sys

import skein

harbour = skein.load("../c/buoy.idl").harbour
vendor, shared_memory, role = sys.argv[1:]


class Buoy(harbour.IBuoy):
    begun = cancelled = 0

    def wind(self, level, at):
        if level == 0:
            raise harbour.Fog("it lies low", at)
        return harbour.Wind(level, at * 2, harbour.Side.Starboard), 77

    def greet(self, name):
        return f"{getattr(self, name)} {name}" if name in ("begun", "cancelled") else f"Ahoy, {name}"

    def forget(self):
        pass

    def gusts(self, count):
        return (harbour.Wind(i, i + 0.5) for i in range(count))

    async def after(self, ms):
        self.begun += 1
        try:
            await asyncio.sleep(ms / 1000)
        except asyncio.CancelledError:
            self.cancelled += 1
            raise
        return ms


class Reporter(harbour.IReporter):
    def report(self, earlier):
        return harbour.Report(earlier.winds, "Python", earlier.depth_m)


async def provide(own):
    own.provide(Buoy(), threads=2)
    own.provide(Reporter(), csp="Python", owner="uav-1/checker")
    depths = own.publisher(harbour.Depth, "depth", profile=skein.Profile.STATE)
    depths.publish(harbour.Depth("quay", 4.5))
    print("provides", flush=True)
    await asyncio.get_running_loop().run_in_executor(None, sys.stdin.read)


async def check(own):
    buoy = (await own.async_connect(harbour.IBuoy, timeout=30)).within(30)

    async def call():
        wind, stamp = await buoy.wind(3, 1.5)
        assert (wind, stamp) == (harbour.Wind(3, 3.0, harbour.Side.Starboard), 77)
        try:
            await buoy.wind(0, 1.25)
        except harbour.Fog as fog:
            return (fog.why, fog.sight_m) == ("it lies low", 1.25)

    async def asynchronous():
        return await asyncio.gather(*(buoy.greet(str(i)) for i in range(20))) == [f"Ahoy, {i}" for i in range(20)]

    async def stream():
        return [gust.force async for gust in buoy.gusts(20)] == list(range(20))

    async def topics():
        async for depth in own.subscribe(harbour.Depth, "depth", profile=skein.Profile.STATE):
            return depth == harbour.Depth("quay", 4.5)

    async def perform():
        """A CSP of the provider, by the Head of this entity."""
        while True:
            try:
                return (await own.async_perform(harbour.IReporter, "report", harbour.Report(depth_m=3.5))).result.depth_m == 3.5
            except skein.Unavailable:
                await asyncio.sleep(0.01)

    async def cancel():
        slow = asyncio.ensure_future(buoy.after(60_000))
        for name in ("begun", "cancelled"):
            while await buoy.greet(name) == f"0 {name}":
                await asyncio.sleep(0.005)
            slow.cancel()
        return True

    async def deadline():
        try:
            await buoy.within(0.1).after(60_000)
        except skein.TimedOut:
            return True

    checks = {"call": call, "asynchronous": asynchronous, "stream": stream, "topics": topics, "CSP": perform, "cancel": cancel, "deadline": deadline}
    for name, feature in checks.items():
        print(name, "ok" if await asyncio.wait_for(feature(), 20) else "wrong", flush=True)


async def main():
    name = "provider" if role == "provide" else "checker"
    async with skein.Entity(name, system="uav-1", vendor=vendor, domain=17, shared_memory_calls=shared_memory == "yes", lease=60) as own:
        await {"provide": provide, "check": check}[role](own)


asyncio.run(main())
