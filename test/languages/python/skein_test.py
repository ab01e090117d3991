"""The package skein on the pairing of vendors that SKEIN_PAIRING names, `server:client`. Arguments: classes of tests; default: all."""

import array
import asyncio
import concurrent.futures
import gc
import os
import random
import signal
import threading
import unittest

import skein
from tools import CLIENT, INSIDE, PATIENCE, PROVIDES, SERVER, Buoy, Peer, archive, entity, eventually, harbour, odd

try:
    import numpy
except ImportError:
    numpy = None


class Harbour(unittest.TestCase):
    """A service of Python's, and its caller."""

    def setUp(self):
        self.buoy = Buoy()
        self.server = self.enterContext(entity("buoy", SERVER))
        self.client = self.enterContext(entity("caller", CLIENT))
        self.server.provide(self.buoy, threads=2)

    def connect(self):
        return self.client.connect(harbour.IBuoy, timeout=PATIENCE)

    def refused(self, error, text, function, *arguments, **named):
        with self.assertRaisesRegex(error, text):
            function(*arguments, **named)


class Odd(unittest.TestCase):
    """Names and values that Python needs care with: odd.idl."""

    def test_names_of_pythons_are_kept_apart(self):
        self.assertEqual((odd.TOWN, odd.BOTH), ("Zürich", odd.Marks.first | odd.Marks.second))
        self.assertEqual((odd.Either(value_=5).value, odd.Either(discriminator_="x").value), (5, "x"))
        self.assertRaises(TypeError, odd.Either, None, 5)
        self.assertEqual(odd.Self(self=3).marks, odd.BOTH)
        self.assertTrue(issubclass(odd.skein.IDerived.Proxy, odd.IBase.Proxy))
        self.assertIsNot(odd.skein, skein)

    def test_a_derived_interface_serves_as_its_base(self):
        told = []

        class Derived(odd.skein.IDerived):
            def ping(self, count):
                raise odd.Lost("at sea")

            def get_x(self, a):
                return a

            def get_x_(self):
                return 7

            def set_x(self, x):
                told.append(x)

            def back(self, self_):
                return self_

            def count(self):
                return range(3)

            async def tell(self, what):
                raise ValueError(what)

        async def serve():
            with skein.Entity("odd", vendor="loopback") as own, skein.Entity("other", vendor="loopback") as other:
                own.provide(Derived())
                base = await other.async_connect(odd.IBase)
                with self.assertRaisesRegex(odd.Lost, "at sea"):
                    await base.ping(1)
                self.assertEqual(await base.get_x(), 7)
                derived = await other.async_connect(odd.skein.IDerived)
                self.assertEqual((await derived.get_x(3), await derived.get_x_()), (3, 7))
                value = odd.Self(1, 2, True, odd.Marks.second, b"x")
                self.assertEqual(await derived.back(value), value)
                with self.assertLogs("skein", "ERROR") as logged:
                    await derived.tell("x")
                    self.assertTrue(await asyncio.to_thread(eventually, lambda: logged.output))

        asyncio.run(serve())


class Values(unittest.TestCase):
    types = harbour.Cargo._skein_types

    def back(self, value):
        """It, as C++ has read, checked and written it."""
        return self.types.decode(value._skein_name, self.types.encode(value._skein_name, value))

    def test_new_values_are_as_idl_says(self):
        self.assertEqual(harbour.Wind(), harbour.Wind(0, 0.0, harbour.Side.Port))
        first, second = harbour.Cargo(), harbour.Cargo()
        first.names.append("fish")
        self.assertEqual(second.names, [])
        self.assertIsNone(first.content)
        self.assertEqual(self.back(second), second)

    def test_a_value_of_every_kind_comes_back(self):
        cargo = harbour.Cargo(
            name="wide \U0001f41f", dangers=harbour.Dangers.fire | harbour.Dangers.poison, seal=harbour.Seal(5, 31),
            sides=[array.array("d", [1, 2, 3]), array.array("d", [4, 5, 6])], shelves=[array.array("i", [1, -2]), array.array("i")],
            winds={"bow": harbour.Wind(1, 2.5)}, content=harbour.Content(winds=[harbour.Wind(7)]), inner=[harbour.Cargo(name="in")],
            mark="x", letter="\u0416", fragile=True, exact=0.25, depth=harbour.Depth("quay", 3.5), names=["", "b"])  # fmt: skip
        self.assertEqual(self.back(cargo), cargo)

    def test_a_union_is_made_and_read_by_its_members(self):
        content = harbour.Content(label="fish")
        self.assertEqual((content.discriminator, content.value, content.label), (harbour.Crane.Small, "fish", "fish"))
        self.assertEqual(harbour.Content(harbour.Crane.Small, "fish"), content)
        with self.assertRaisesRegex(AttributeError, "holds label, and not 'winds'"):
            content.winds
        with self.assertRaisesRegex(TypeError, "no member 'fish'; it has label, winds"):
            harbour.Content(fish=1)

    def test_what_fits_no_member_is_refused_with_its_place(self):
        for value, text in (
            (harbour.Wind(256), "harbour::Wind.force takes an int from 0 to 255, and was given 256"),
            (harbour.Wind("x"), "takes an int"),
            (harbour.Wind(speed_m_s="x"), "harbour::Wind.speed_m_s takes a number"),
            (harbour.Wind(from_=7), "takes a harbour::Side"),
            (harbour.Cargo(names="abc"), "harbour::Cargo.names takes a list"),
            (harbour.Cargo(names=[1]), "takes a str"),
            (harbour.Cargo(name="a", sides=[[1, 2, 3]]), "takes 2 elements, and was given 1"),
            (harbour.Cargo(sides=[[1, 2], [3, 4]]), "takes 3 elements, and was given 2"),
            (harbour.Cargo(mark="xy"), "a str of one character"),
            (harbour.Cargo(fragile=1), "True or False"),
            (harbour.Cargo(sides=array.array("d", [1] * 6)), "takes 2 elements, and was given 6"),
            (harbour.Cargo(sides=memoryview(bytes(48)).cast("d", (3, 2))), "takes 2 elements, and was given 3"),
            (harbour.Depth(["ä" * 100] * 40), "was given 40 elements, of type list"),
            (harbour.Depth(b"\xc3" * 100), "takes a str"),
            (harbour.Cargo(seal=harbour.Seal(8, 0)), r"harbour::Cargo.seal.ring takes an int of 3 bits"),
            (harbour.Cargo(content=harbour.Content(label="x" * 41)), "label"),
            (harbour.Cargo(content="x"), "takes a harbour::Content"),
            (harbour.Depth("a\0b"), r"takes a str without \\0"),
            (harbour.Cargo(winds={"a": "b"}), "takes a harbour::Wind"),
            (harbour.Cargo(winds=[]), "takes a dict"),
        ):  # fmt: skip
            with self.subTest(value=value), self.assertRaisesRegex(skein.InvalidArgument, text):
                self.back(value)

    def test_a_value_that_contains_itself_is_refused(self):
        cargo = harbour.Cargo()
        cargo.inner = [cargo]
        with self.assertRaisesRegex(skein.InvalidArgument, "nested"):
            self.back(cargo)

    def test_numbers_are_taken_from_buffers_and_lie_in_one(self):
        shelves = [range(3), array.array("i", [4]), array.array("q", [5]), memoryview(array.array("i", [6, 7]))[:1]]
        back = self.back(harbour.Cargo(shelves=shelves)).shelves
        self.assertEqual([list(each) for each in back], [[0, 1, 2], [4], [5], [6]])
        self.assertEqual(memoryview(back[0]).format, "i")
        self.assertRaises(skein.InvalidArgument, self.back, harbour.Cargo(shelves=[array.array("d", [1])]))

    @unittest.skipUnless(numpy, "numpy is not installed")
    def test_numpy_gives_and_takes_numbers(self):
        sides = numpy.arange(6.0).reshape(2, 3)
        back = self.back(harbour.Cargo(sides=sides, shelves=list(numpy.eye(2, dtype="int32")), fragile=numpy.bool_(True)))
        self.assertTrue((numpy.array(back.sides) == sides).all())
        self.assertTrue((numpy.asarray(back.shelves[1]) == [0, 1]).all())
        self.assertEqual(self.back(harbour.Wind(numpy.uint8(3), numpy.float32(0.5))), harbour.Wind(3, 0.5))
        column = numpy.zeros((3, 2), dtype="int32")[:, 0]  # not contiguous
        self.assertEqual(list(self.back(harbour.Cargo(shelves=[column])).shelves[0]), [0, 0, 0])

    def test_text_that_is_no_utf8_leaves_as_it_came(self):
        odd = b"a\xffb".decode("utf-8", "surrogateescape")
        self.assertEqual(self.back(harbour.Depth(odd)).place, odd)

    def test_whatever_comes_is_read_or_refused(self):
        message = bytearray(self.types.encode("harbour::Cargo", harbour.Cargo(names=["a", "b"], inner=[harbour.Cargo()])))
        draw = random.Random(7)
        for _ in range(3000):
            spoilt = bytearray(message)
            for _ in range(draw.randint(1, 4)):
                spoilt[draw.randrange(4, len(spoilt))] = draw.randrange(256)
            try:
                self.types.decode("harbour::Cargo", bytes(spoilt[: draw.randint(4, len(spoilt))]))
            except skein.Error:
                pass


class Wire(Harbour):
    """What the gate runs on real vendors."""

    def test_calls_bring_results_and_exceptions(self):
        buoy = self.connect()
        self.assertEqual(buoy.greet("you"), "Ahoy, you")
        self.assertEqual(buoy.wind(at=1.5, level=3), (harbour.Wind(3, 3.0, harbour.Side.Starboard), 77))
        with self.assertRaises(harbour.Fog) as caught:
            buoy.wind(0, 1.25)
        self.assertEqual((caught.exception.why, caught.exception.sight_m), ("it lies low", 1.25))
        self.assertIsNone(buoy.forget())
        self.assertTrue(eventually(lambda: self.buoy.forgotten == 1))
        self.assertEqual([gust.force for gust in buoy.gusts(100)], list(range(100)))

    def test_asyncio_awaits_calls_streams_and_topics(self):
        depths = self.server.publisher(harbour.Depth, "depth", profile=skein.Profile.STATE)

        async def sail():
            buoy = await self.client.async_connect(harbour.IBuoy, timeout=PATIENCE)
            self.assertEqual(await asyncio.gather(*(buoy.greet(str(i)) for i in range(50))), [f"Ahoy, {i}" for i in range(50)])
            self.assertEqual([gust.speed_m_s async for gust in buoy.gusts(3)], [0.5, 1.5, 2.5])
            depths.publish(harbour.Depth("quay", 4))
            async for depth in self.client.subscribe(harbour.Depth, "depth", profile=skein.Profile.STATE):
                return depth

        self.assertEqual(asyncio.run(sail()), harbour.Depth("quay", 4.0))

    def test_an_interface_is_learned_from_its_provider(self):
        buoy = self.client.connect("harbour::IBuoy", timeout=PATIENCE)
        wind, stamp = buoy.wind(2, 3)
        self.assertEqual((wind.force, stamp), (2, 77))


@unittest.skipIf(INSIDE, "one process")
class Processes(unittest.TestCase):
    """The lease is a minute: of a death the kernel tells. The gate runs this on real vendors, too."""

    def entity(self, name, vendor):
        return self.enterContext(entity(name, vendor, lease=60))

    def test_python_calls_c(self):
        with Peer.in_c(SERVER, "provide") as peer:
            peer.expect("provides")
            self.assertEqual(self.entity("caller", CLIENT).connect(harbour.IBuoy, timeout=PATIENCE).greet("you"), "you")

    def test_what_cxx_lends_to_python_is_copied_and_arrives_unchanged(self):
        class Archive(archive.IArchive):
            def weigh(self, name, chart, factor):
                return sum(chart.soundings) * chart.scale * factor, chart.drawn_at

        self.entity("archive", SERVER).provide(Archive())
        with Peer(os.environ["SKEIN_LENDING_CALLER"], CLIENT) as peer:
            peer.expect("unchanged")

    def test_the_death_of_a_provider_ends_its_calls(self):
        with Peer.python(PROVIDES) as peer:
            peer.expect("provides")
            call = self.entity("caller", CLIENT).connect(harbour.IBuoy, timeout=PATIENCE).within(60).asynchronous.greet("nobody")
            peer.expect("called")
            self.assertFalse(call.done())
            peer.kill()
            self.assertRaises(skein.Disconnected, call.result, PATIENCE)

    def test_the_death_of_a_caller_cancels_its_calls(self):
        called, cancelled, never = threading.Event(), threading.Event(), concurrent.futures.Future()

        class Waiting(Buoy):
            def greet(self, name):
                skein.current_call().on_cancel(cancelled.set)
                called.set()
                return never

        self.entity("waiting", SERVER).provide(Waiting())
        with Peer.in_c(CLIENT, "call") as peer:
            self.assertTrue(called.wait(PATIENCE))
            self.assertFalse(cancelled.is_set())
            peer.kill()
            self.assertTrue(cancelled.wait(PATIENCE))

    def test_a_client_survives_its_providers_lives(self):
        own, buoy = self.entity("faithful", CLIENT), None
        for _ in range(2):
            with Peer.python(PROVIDES) as peer:
                peer.expect("provides")
                buoy = buoy or own.connect(harbour.IBuoy, timeout=PATIENCE)
                self.assertEqual(buoy.within(PATIENCE).greet("you"), "Ahoy, you")


class Calls(Harbour):
    def test_errors_say_what_can_be_done(self):
        buoy = self.connect()
        self.refused(skein.Unavailable, "IReporter", self.client.connect, harbour.IReporter, timeout=0.1)
        self.refused(TimeoutError, "", buoy.within(0.05).after, 5000)
        self.refused(TypeError, "greet\\(name\\) takes no argument 'nam'; did you mean 'name'", buoy.greet, nam="x")
        self.refused(TypeError, "lacks at", buoy.wind, 3)
        self.refused(TypeError, "was given 2 arguments", buoy.greet, "a", "b")
        self.refused(ValueError, "harbour::IBuoy::greet.name takes a str", buoy.greet, 3)
        self.refused(skein.InvalidArgument, "more than 0", buoy.within, 0)
        self.refused(skein.InvalidArgument, "is no interface", self.client.connect, harbour.Wind)
        self.refused(skein.InvalidArgument, "is no condition", self.client.connect, harbour.IBuoy, where=["fast"])
        self.refused(skein.InvalidArgument, "identity has 16 bytes", self.client.connect, harbour.IBuoy, provider=b"x")

    def test_a_call_is_a_future(self):
        later = self.connect().asynchronous
        told = threading.Event()
        call = later.greet("you")
        call.add_done_callback(lambda done: told.set())
        self.assertEqual(call.result(PATIENCE), "Ahoy, you")
        self.assertTrue(told.wait(PATIENCE))
        self.assertIsInstance(later.wind(0, 1).exception(PATIENCE), harbour.Fog)
        slow = later.after(20_000)
        self.assertTrue(slow.cancel())
        self.assertRaises(concurrent.futures.CancelledError, slow.result)

    def test_what_a_task_gives_up_is_cancelled_at_its_provider(self):
        ended = []
        self.buoy.after = lambda ms: ended.append(ms) or Buoy.after(self.buoy, ms)

        async def impatient():
            buoy = await self.client.async_connect(harbour.IBuoy)
            async with asyncio.timeout(0.05):
                await buoy.after(20_000)

        self.server.close()
        self.server = self.enterContext(entity("buoy", SERVER))
        self.server.provide(self.buoy)
        self.assertRaises(TimeoutError, asyncio.run, impatient())
        self.assertTrue(eventually(lambda: ended))

    def test_a_stream_that_is_closed_ends_at_its_provider(self):
        ended = threading.Event()

        class Endless(Buoy):
            def gusts(self, count):
                try:
                    while True:
                        yield harbour.Wind(count)
                finally:
                    ended.set()

        self.server.provide(Endless(), attributes={"quality": 0.9})
        with self.client.connect(harbour.IBuoy, where=["quality >= 0.5"]).within(60).gusts(4) as gusts:
            self.assertEqual(next(gusts).force, 4)
        self.assertTrue(ended.wait(PATIENCE))

    def test_a_connection_may_be_used_and_closed_by_any_thread(self):
        buoy = self.connect()
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            self.assertEqual(set(pool.map(buoy.greet, ["you"] * 400)), {"Ahoy, you"})
        with self.assertRaises(AttributeError):
            buoy.knots = 3
        buoy.close()
        self.assertFalse(buoy.connected)
        self.assertRaises(skein.Error, buoy.greet, "you")

    def test_a_callback_may_call(self):
        """It runs under no lock, of the vendor or of Skein."""
        buoy, told = self.connect(), []
        buoy.asynchronous.greet("you").add_done_callback(lambda done: told.append(buoy.greet(done.result())))
        self.assertTrue(eventually(lambda: told == ["Ahoy, Ahoy, you"]))


class Services(Harbour):
    def answer(self, service, **options):
        """A proxy for this service alone."""
        provider = self.server.provide(service, **options)
        return self.client.connect(harbour.IBuoy, provider=provider.identity, timeout=PATIENCE)

    def test_what_a_service_throws_is_told_by_its_class(self):
        class Failing(Buoy):
            def greet(self, name):
                raise {"late": skein.Overloaded("not now"), "fog": harbour.Fog("?"), "bug": KeyError("x")}[name]

        buoy = self.answer(Failing())
        self.refused(skein.Overloaded, "not now", buoy.greet, "late")
        with self.assertLogs("skein", "ERROR"):
            self.refused(skein.Internal, "KeyError: 'x'", buoy.greet, "bug")
            self.refused(skein.Internal, "Fog is no exception that the operation declares", buoy.greet, "fog")

    def test_a_result_that_is_none_is_an_error_of_the_service(self):
        class Wrong(Buoy):
            def greet(self, name):
                return 3

            def wind(self, level, at):
                return harbour.Wind()

        buoy = self.answer(Wrong())
        with self.assertLogs("skein", "ERROR"):
            self.refused(skein.Internal, "takes a str, and was given 3", buoy.greet, "x")
            self.refused(skein.Internal, "has 2 results: return them as a tuple", buoy.wind, 1, 1)

    def test_a_class_that_lacks_an_operation_is_refused(self):
        class Greet(harbour.IBuoy):
            def great(self, name):
                return name

        self.refused(skein.InvalidArgument, "lacks wind, greet, forget, gusts, after", self.server.provide, Greet())
        self.refused(skein.InvalidArgument, "derives from no IDL interface", self.server.provide, object())
        self.refused(skein.InvalidArgument, "give an object of it, Buoy\\(\\)", self.server.provide, Buoy)

    def test_an_answer_that_nobody_can_give_any_more_is_an_error(self):
        class Forgetful(Buoy):
            def greet(self, name):
                return concurrent.futures.Future()

        self.refused(skein.Internal, "was not answered", self.answer(Forgetful()).greet, "you")

    def test_an_answer_may_come_later(self):
        promised = concurrent.futures.Future()

        class Later(Buoy):
            def greet(self, name):
                return promised

        call = self.answer(Later()).asynchronous.greet("you")
        self.assertFalse(call.done())
        promised.set_result("now")
        self.assertEqual(call.result(PATIENCE), "now")

    def test_coroutines_answer_on_the_loop_of_who_provides(self):
        class Polite(Buoy):
            async def greet(self, name):
                await asyncio.to_thread(list)
                return f"{name} {threading.current_thread() is threading.main_thread()} {skein.current_call().time_left > 0}"

            async def gusts(self, count):
                for i in range(count):
                    yield harbour.Wind(i)

        async def serve():
            provider = self.server.provide(Polite())
            buoy = (await self.client.async_connect(harbour.IBuoy, provider=provider.identity)).within(PATIENCE)
            self.assertEqual(await buoy.greet("you"), "you True True")
            self.assertEqual([gust.force async for gust in buoy.gusts(3)], [0, 1, 2])

        asyncio.run(serve())
        self.refused(skein.InvalidArgument, "without a running event loop", self.server.provide, Polite())

    def test_what_nobody_waits_for_is_cancelled_and_occupies_no_thread(self):
        begun, cancelled = threading.Event(), []

        class Slow(Buoy):
            async def wait(self, what):
                begun.set()
                try:
                    await asyncio.Event().wait()
                finally:
                    cancelled.append(what)

            async def greet(self, name):
                return name if name else await self.wait("greet")

            async def gusts(self, count):
                yield harbour.Wind(count)
                await self.wait("gusts")

        async def serve():
            provider = self.server.provide(Slow())
            buoy = (await self.client.async_connect(harbour.IBuoy, provider=provider.identity)).within(PATIENCE)
            waiting = asyncio.ensure_future(buoy.greet(""))
            await asyncio.to_thread(begun.wait, PATIENCE)
            waiting.cancel()
            async for gust in buoy.gusts(3):
                self.assertEqual(gust.force, 3)
                break
            self.assertEqual(await buoy.greet("you"), "you")
            self.assertTrue(await asyncio.to_thread(eventually, lambda: set(cancelled) == {"greet", "gusts"}))

        asyncio.run(serve())

    def test_a_stream_that_fails_is_not_complete(self):
        class Failing(Buoy):
            def gusts(self, count):
                yield harbour.Wind()
                raise skein.Cancelled("inside")

        gusts = self.answer(Failing()).gusts(3)
        next(gusts)
        self.refused(skein.Cancelled, "inside", next, gusts)

    def test_a_reference_leads_to_its_service(self):
        reference = self.server.provide(Buoy()).reference
        self.assertEqual(reference.interface, "harbour/IBuoy")
        self.assertEqual(self.client.connect(harbour.IBuoy, provider=reference.provider).greet("you"), "Ahoy, you")

    def test_a_service_may_be_withdrawn_and_drained(self):
        buoy = self.connect()
        self.assertEqual(buoy.greet("a"), "Ahoy, a")
        self.assertTrue(self.server.drain(PATIENCE))
        self.assertRaises(skein.Unavailable, buoy.within(0.2).greet, "b")


class Tasks(Harbour):
    def setUp(self):
        self.server = self.enterContext(entity("owner", SERVER))
        for name, speed in (("slow", 1.0), ("fast", 9.0)):
            self.server.provide(self.csp(speed), csp=name)

    @staticmethod
    def csp(speed):
        csp = Buoy()
        csp.wind = lambda level, at: (harbour.Wind(level, speed), 0)
        return csp

    def test_the_head_selects_among_csps(self):
        outcome = self.server.perform(
            harbour.IBuoy, "wind", 3, 1.0, evaluate=lambda result: result[0].speed_m_s > 5 or "too slow", quality=lambda result: result[0].speed_m_s)  # fmt: skip
        self.assertEqual(outcome.result[0].speed_m_s, 9.0)
        self.assertEqual(outcome.decision["attempts"][-1]["csp"], "fast")
        cheapest = self.server.perform(harbour.IBuoy, "wind", 3, 1.0, execution="all", enough=None, cost=lambda result: result[0].speed_m_s)
        self.assertEqual(cheapest.result[0].speed_m_s, 1.0)
        self.assertEqual(self.server.perform(harbour.IBuoy, "wind", 3, 1.0, only="fast").result[0].speed_m_s, 9.0)

    def test_a_task_that_brings_nothing_says_why(self):
        perform = self.server.perform
        self.refused(skein.Internal, "never", perform, harbour.IBuoy, "wind", 3, 1.0, evaluate=lambda result: "never")
        other = self.enterContext(entity("other", CLIENT))
        self.refused(skein.Unavailable, "", other.perform, harbour.IBuoy, "wind", 3, 1.0, limit=0.2)
        self.refused(skein.Internal, "returned None", perform, harbour.IBuoy, "wind", 3, 1.0, evaluate=lambda result: None)
        self.refused(skein.Internal, "ZeroDivisionError", perform, harbour.IBuoy, "wind", 3, 1.0, evaluate=lambda result: 1 / 0)
        self.refused(TypeError, "wind\\(level, at\\) lacks at", perform, harbour.IBuoy, "wind", 3)
        self.refused(skein.InvalidArgument, "no operation 'wnd'; it has wind", perform, harbour.IBuoy, "wnd")
        self.refused(skein.InvalidArgument, "take one, staggered, all", perform, harbour.IBuoy, "wind", 3, 1.0, execution="some")


class Topics(Harbour):
    def test_values_come_by_callbacks_and_by_iteration(self):
        told, depths = [], self.server.publisher(harbour.Depth, "depth")
        waiting = self.client.subscribe(harbour.Depth, "depth", queue=3)
        calling = self.client.subscribe(harbour.Depth, "depth", told.append)
        self.assertTrue(eventually(lambda: (depths.subscribers, waiting.publishers, calling.publishers) == (2, 1, 1)))
        for i in range(5):
            depths.publish(harbour.Depth("quay", i))
        self.assertTrue(depths.wait_for_acknowledgments(PATIENCE))
        self.assertTrue(eventually(lambda: len(told) == 5 and waiting.dropped == 2))
        self.assertEqual(next(waiting), harbour.Depth("quay", 2.0))
        calling.close()
        waiting.close()
        self.assertEqual([depth.depth_m for depth in waiting], [3.0, 4.0])
        self.assertIsNone(waiting.take(0.01))

    def test_the_end_of_an_entity_ends_iterations(self):
        subscription = self.client.subscribe(harbour.Depth, "depth")
        with concurrent.futures.ThreadPoolExecutor() as pool:
            left = pool.submit(list, subscription)
            self.client.close()
            self.assertEqual(left.result(PATIENCE), [])

    def test_a_topics_type_is_learned_from_who_uses_it(self):
        depths = self.server.publisher(harbour.Depth, "depth")
        made = self.client.fetch_type("depth", timeout=PATIENCE)
        self.assertIs(made, harbour.Depth)
        self.assertEqual(depths.subscribers, 0)

    def test_what_is_no_value_of_the_topic_is_refused(self):
        depths = self.server.publisher(harbour.Depth, "depth")
        self.refused(skein.InvalidArgument, "takes a harbour::Depth", depths.publish, 3)
        self.refused(skein.InvalidArgument, "no class of an IDL struct", self.server.publisher, int, "depth")

    def test_a_callback_may_end_what_it_stands_in(self):
        depths, told = self.server.publisher(harbour.Depth, "depth"), []

        def close(_):
            try:
                subscription.close()
            except skein.InvalidArgument as refused:
                told.append(str(refused))

        subscription = self.client.subscribe(harbour.Depth, "depth", close)
        self.assertTrue(eventually(lambda: depths.subscribers == subscription.publishers == 1))
        depths.publish(harbour.Depth())
        self.assertTrue(eventually(lambda: told))
        self.assertIn("callback of this subscription", told[0])


class Lives(Harbour):
    def run_script(self, script, *signals):
        """The exit code of one that was sent signals as it said `now`."""
        with Peer.python(script) as peer:
            for number in signals:
                peer.expect("now")
                peer.kill(number)
            return peer.end()

    def test_objects_may_be_forgotten_in_any_order(self):
        for order in range(6):
            server, client = entity(f"s{order}", SERVER), entity(f"c{order}", CLIENT)
            provider, told = server.provide(Buoy()), []
            buoy = client.connect(harbour.IBuoy, name=f"s{order}", timeout=PATIENCE)
            subscription = client.subscribe(harbour.Depth, "depth", told.append)
            calls = [buoy.asynchronous.greet("you") for _ in range(20)]
            held = [server, client, provider, buoy, subscription]
            del server, client, provider, buoy, subscription
            random.Random(order).shuffle(held)
            while held:
                held.pop()
                gc.collect()
            self.assertTrue(all(eventually(call.done) for call in calls))
        with self.assertLogs("skein", "WARNING") as told:
            entity("careless", SERVER).provide(Buoy())
            gc.collect()
        self.assertIn("'careless' ends with its services", told.output[0])

    def test_ctrl_c_ends_every_wait(self):
        for wait in (
            "own.connect(harbour.IReporter, timeout=60)",
            "own.fetch('nobody', 60)",
            "buoy.after(50_000)",
            "next(buoy.gusts(1))",
            "buoy.asynchronous.after(50_000).result()",
            "next(own.subscribe(harbour.Depth, 'depth'))",
            "own.perform(harbour.IBuoy, 'after', 50_000)",
            "asyncio.run(asyncio.wait_for(asyncio.Event().wait(), 60))",
            "asyncio.run(own.async_connect(harbour.IReporter, timeout=60))",
            "asyncio.run(anext(aiter(buoy.gusts(1))))",
        ):
            script = f"""
import asyncio, threading
class Slow(Buoy):
    def gusts(self, count):
        call = skein.current_call()
        eventually(lambda: call.cancelled)
        return []
with entity("own", "loopback") as own, entity("other", "loopback") as other:
    other.provide(Slow(), threads=3)
    own.provide(Slow(), csp="slow")
    buoy = own.connect(harbour.IBuoy, name="other").within(60)
    threading.Timer(0.1, print, ["now"], {{"flush": True}}).start()
    try:
        {wait}
    except KeyboardInterrupt:
        sys.exit(3)
"""
            with self.subTest(wait=wait):
                self.assertEqual(self.run_script(script, signal.SIGINT), 3)

    def test_wait_ends_by_a_signal(self):
        script = "import threading; threading.Timer(0.1, print, ['now'], {'flush': True}).start(); sys.exit(4 if skein.wait() else 5)"
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.assertEqual(self.run_script(script, number), 4)
        self.assertFalse(skein.wait(0.01))
        script = "import asyncio, threading; threading.Timer(0.1, print, ['now'], {'flush': True}).start(); asyncio.run(skein.async_wait()); sys.exit(4)"
        self.assertEqual(self.run_script(script, signal.SIGTERM), 4)

        async def wrong():
            skein.wait()

        self.refused(skein.InvalidArgument, "await skein.async_wait", asyncio.run, wrong())

    def test_a_process_may_end_while_threads_go_on(self):
        script = """
import threading
own, other = entity("own", "loopback"), entity("other", "loopback")
class Busy(Buoy):
    def after(self, ms):
        print("called", flush=True)
        while True:
            pass
other.provide(Busy(), threads=4)
buoy = own.connect(harbour.IBuoy)
def stubborn():
    while True:
        try:
            buoy.greet("you")
        except skein.Error:
            pass
for _ in range(3):
    threading.Thread(target=stubborn, daemon=True).start()
if sys.argv[1:]:
    buoy.asynchronous.after(60_000)
    sys.stdin.read()
sys.exit(6)
"""
        for _ in range(5):
            self.assertEqual(self.run_script(script), 6)
        with Peer.python(script, "busy") as peer:
            self.assertEqual(peer.expect("called").end(), 6)

    def test_a_process_may_end_with_all_of_it_alive(self):
        script = """
import threading
own, other = entity("own", "loopback"), entity("other", "loopback")
other.provide(Buoy(), threads=4)
buoy = own.connect(harbour.IBuoy)
depths, kept = other.publisher(harbour.Depth, "depth"), []
subscription = own.subscribe(harbour.Depth, "depth", kept.append)
def busy():
    try:
        while True:
            buoy.greet("you"); depths.publish(harbour.Depth())
    except skein.Error:
        pass  # at the end
for _ in range(3):
    threading.Thread(target=busy, daemon=True).start()
calls = [buoy.asynchronous.after(60_000) for _ in range(3)]
eventually(lambda: kept)
sys.exit(6)
"""
        self.assertEqual(self.run_script(script), 6)

    def test_a_forked_child_is_told_and_may_end(self):
        child = os.fork()
        if child == 0:
            try:
                self.client.connect(harbour.IBuoy)
            except RuntimeError as error:
                os._exit(7 if "forked" in str(error) else 8)
            os._exit(9)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 7)
        self.assertEqual(self.connect().greet("you"), "Ahoy, you")

    def test_memory_stays_flat(self):
        buoy = self.connect()

        def used():
            gc.collect()
            with open("/proc/self/statm", encoding="ascii") as statm:
                return int(statm.read().split()[1]) * 4

        def work(times):
            for i in range(times):
                buoy.wind(3, 1.5)
                if i % 50 == 0:
                    list(buoy.gusts(3))
                    buoy.asynchronous.greet("you").result()
                    self.assertRaises(harbour.Fog, buoy.wind, 0, 1)

        times = int(os.environ.get("SKEIN_PYTHON_CALLS", 6000))
        work(times)
        before = used()
        work(times)
        self.assertLess(used() - before, 2048, "KiB more than after the first half")

    def test_what_python_logs_goes_to_skeins_log(self):
        script = "import logging; logging.getLogger().addHandler(skein.LogHandler()); logging.getLogger('sonar').warning('it %s', 'leaks')"
        with Peer.python("import os; os.dup2(1, 2)\n" + script) as peer:
            told = peer.process.stdout.read()
        self.assertRegex(told, "sonar.*it leaks")


if __name__ == "__main__":
    unittest.main(verbosity=2)
