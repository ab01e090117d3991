"""The pages that tell of a mission and of routes, as people use them, in headless Chromium.

python3 page_test.py PROGRAM..., which write pages into a folder."""

import base64
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[4] / "test" / "tools"))
import headless_chromium  # noqa: E402

PROGRAMS = sys.argv[1:]

# Relative luminance and contrast as WCAG 2.1 defines them.
CONTRAST = """(pairs => {
    const style = getComputedStyle(document.documentElement), canvas = document.createElement("canvas").getContext("2d", {willReadFrequently: true});
    const luminance = name => {
        canvas.fillStyle = style.getPropertyValue("--" + name);
        canvas.fillRect(0, 0, 1, 1);
        const [r, g, b] = [...canvas.getImageData(0, 0, 1, 1).data].map(v => v / 255).map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    return pairs.map(([text, ground]) => {
        const [a, b] = [luminance(text), luminance(ground)].sort((x, y) => y - x);
        return [text, ground, (a + 0.05) / (b + 0.05)];
    });
})(%s)"""
PAIRS = [[text, ground] for text in ("ink", "soft", "good", "bad") for ground in ("card", "page")]


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(place.cleanup)
        cls.folder = pathlib.Path(place.name)
        for program in PROGRAMS:
            subprocess.run([program, cls.folder], check=True, timeout=60)
        cls.page = headless_chromium.Page()
        cls.addClassCleanup(cls.page.__exit__)

    def open(self, name="flown.html", width=1280, height=900):
        self.page.complaints()
        self.page.prefer("light")
        self.page.resize(width, height)
        self.page.open(self.folder / name)
        self.addCleanup(lambda: self.assertEqual(self.page.complaints(), []))

    def of(self, expression):
        return self.page.value(expression)


class Report(Page):
    def places(self):
        """Of all that goes with the time."""
        return self.of("""["#map > .aircraft", "#profile .cursor_dot"].map(each => document.querySelector(each).getAttribute("transform"))
            .concat(["#map .flown", "#profile .cursor", "#lanes .cursor"].map(each => document.querySelector(each).getAttribute("d")))""")

    def test_the_first_line_is_the_verdict(self):
        self.open()
        self.assertRegex(self.of("document.querySelector('h1').textContent"), r"^Passed · \d+ min \d\d s · .* km · 3 of 3 targets · .* · 1 miss$")

    def test_the_slider_moves_all_that_goes_with_the_time(self):
        self.open()
        self.of("document.getElementById('slider').focus()")
        at_the_end = self.places()
        self.page.press("Home", 36)
        at_the_beginning = self.places()
        self.assertEqual(self.of("document.getElementById('clock').textContent"), "00:01")
        self.page.press("PageUp", 33)
        later = self.places()
        for first, second, third in zip(at_the_end, at_the_beginning, later):
            self.assertEqual(len({first, second, third}), 3, (first, second, third))

    def test_threats_images_and_routes_appear_when_they_are_known(self):
        self.open()
        shown = """[[...document.querySelectorAll('#map .site')].filter(each => each.parentElement.style.opacity === '1').length,
            ...['.image', '.route'].map(name => [...document.querySelectorAll('#map ' + name)].filter(each => each.style.display !== 'none').length)]"""
        threats, images, routes = self.of(shown)
        self.assertEqual((threats, routes), (3, 3))
        self.assertGreater(images, 10)
        self.of("document.getElementById('slider').focus()")
        self.page.press("Home", 36)
        self.assertEqual(self.of(shown), [0, 0, 0])

    def test_a_followed_target_and_an_emitter_are_told_by_what_was_wanted_of_them(self):
        self.open("pursuit.html")
        rows = self.of("[...document.querySelectorAll('#targets tbody tr')].map(row => [...row.children].slice(0, 3).map(cell => cell.textContent))")
        self.assertEqual(rows, [["convoy", "followed 300 s", "300 s"], ["van", "followed 300 s", "not found"], ["north", "within 100 m", "80 m"]])
        self.assertTrue(self.of("document.getElementById('targets_note').hidden"))
        # Its path grows with the time, and so does that of where it truly was.
        paths = "['#map .followed', '#map .truth path'].map(each => document.querySelector(each).getAttribute('d').length)"
        at_the_end = self.of(paths)
        self.of("document.getElementById('slider').focus()")
        self.page.press("Home", 36)
        self.assertEqual(self.of(paths)[0], 0)
        self.assertLess(self.of(paths)[1], at_the_end[1] / 10)
        self.assertGreater(at_the_end[0], 1000)

    def test_playing_moves_the_time_until_it_is_paused(self):
        self.open()
        self.page.click("#play")
        self.assertEqual(self.of("document.getElementById('play').getAttribute('aria-label')"), "Pause")
        slider = "document.getElementById('slider').value"
        self.page.until(f"{slider} > 5 && {slider} < 600")  # it stood at the end
        self.page.click("#play")
        self.assertEqual(self.of("document.getElementById('play').getAttribute('aria-label')"), "Play")

    def test_a_click_on_a_decision_tells_its_reason(self):
        for plot in ("#map", "#lanes"):
            with self.subTest(plot):
                self.open()
                self.page.click(f"{plot} .decision.late")
                told = self.of("document.getElementById('told').innerText")
                self.assertIn("RRTConnect", told)
                self.assertIn("AStar was asked first, and its process was killed", told)
                self.assertIn("disconnected", told)
                self.assertEqual(self.of("document.querySelectorAll('#map .chosen, #lanes .chosen').length"), 2)
                when = self.of("document.getElementById('clock').textContent")
                self.assertIn(when, told)

    def test_a_click_on_a_line_of_the_list_opens_it(self):
        self.open()
        self.page.click("#decisions details:nth-child(2) summary")
        self.assertIn("answered 3 of 3 similar requests", self.of("document.querySelector('#decisions details[open]').innerText"))

    def test_a_click_on_a_flag_and_on_a_plot_sets_the_time(self):
        self.open()
        self.page.click("#flags li:nth-child(2) span")
        self.assertEqual(self.of("document.getElementById('clock').textContent"), "04:11")
        x, y = self.page.middle_of("#profile")
        self.page.click_at(x, y)
        self.assertNotEqual(self.of("document.getElementById('clock').textContent"), "04:11")

    def test_parts_of_the_map_can_be_left_out(self):
        self.open()
        self.page.click("#legend label:has(.coverage)")
        self.assertEqual(self.of("getComputedStyle(document.querySelector('#map .coverage')).display"), "none")

    def test_it_is_light_or_dark_as_people_prefer_and_is_legible_in_both(self):
        self.open()
        for scheme in ("light", "dark"):
            with self.subTest(scheme):
                self.page.prefer(scheme)
                self.page.until(f"document.documentElement.dataset.theme === '{scheme}'")
                for text, ground, contrast in self.of(CONTRAST % json.dumps(PAIRS)):
                    self.assertGreaterEqual(contrast, 4.5, (text, ground))
        self.page.click("#theme")
        self.assertEqual(self.of("document.documentElement.dataset.theme"), "light")

    def test_a_phone_shows_all_of_it_without_scrolling_sideways(self):
        self.open(width=360, height=740)
        self.assertLessEqual(self.of("document.documentElement.scrollWidth"), 360)
        small = self.of("""[...document.querySelectorAll('body *')].filter(each => each.getClientRects().length && [...each.childNodes].some(child =>
            child.nodeType === 3 && child.textContent.trim()) && parseFloat(getComputedStyle(each).fontSize) < 11).map(each => each.outerHTML)""")
        self.assertEqual(small, [])
        box = self.of("(({left, right, bottom}) => [left, right, bottom])(document.getElementById('slider').getBoundingClientRect())")
        self.assertGreaterEqual(box[0], 0)
        self.assertLessEqual(box[1], 360)
        self.assertLessEqual(box[2], 740)

    def test_it_is_printed_in_light_with_all_reasons_and_is_then_as_before(self):
        self.open()
        self.page.prefer("dark")
        self.page.until("document.documentElement.dataset.theme === 'dark'")
        self.of("addEventListener('beforeprint', () => { window.printed = [document.documentElement.dataset.theme, document.querySelectorAll('details:not([open])').length]; })")
        self.assertTrue(base64.b64decode(self.page.printed()).startswith(b"%PDF"))
        self.assertEqual(self.of("window.printed"), ["light", 0])
        self.assertEqual(self.of("[document.documentElement.dataset.theme, document.querySelectorAll('details[open]').length]"), ["dark", 0])

    def test_texts_that_would_be_markup_are_shown_as_they_are(self):
        self.open("hostile.html")
        self.page.click("#lanes .decision")
        self.assertEqual(self.of("[document.scripts.length, document.images.length]"), [2, 0])
        self.assertTrue(self.of("document.title").startswith("</script><script>alert(1)</script><img src=x onerror=alert(2)>"))
        for part in ("#targets", "#told", "#checks", "#command", "#map", "#lanes", "#faults", "#latencies"):
            with self.subTest(part):
                self.assertIn("</script><script>alert(1)</script><img src=x onerror=alert(2)>", self.of(f"document.querySelector('{part}').textContent"))

    def test_a_mission_that_never_began_is_told_of_too(self):
        self.open("grounded.html")
        self.assertIn("Not flown to its end", self.of("document.body.innerText"))
        self.assertIn("the mission was aborted", self.of("document.getElementById('checks').innerText"))
        self.assertEqual(self.of("document.querySelector('.map').hidden"), True)


class Routes(Page):
    def test_routes_are_drawn_listed_and_told_apart(self):
        self.open("routes.html")
        labels = "[...document.querySelectorAll('#routes li')].map(each => each.innerText.split('\\n'))"
        first, second, third = self.of(labels)
        self.assertEqual([first[0], second[0], third], ["first", "second", ["third", third[1], "not drawn: not a route"]])
        self.assertRegex(first[1], r"^\d+\.\d km, exposure \d+\.\d km$")
        self.assertRegex(first[2], r"^at least \d+ m above ground$")
        # Each whole, and then dashes that take turns; the third is not there.
        dashed = self.of("""[...document.querySelectorAll('#map .way[stroke-dasharray]')].map(each => [each.getAttribute('d').length > 0, each.style.stroke,
            each.getAttribute('stroke-dasharray'), each.getAttribute('stroke-dashoffset')])""")
        self.assertEqual([each[0] for each in dashed], [True, True, False])
        self.assertEqual(len({each[1] for each in dashed}), 3)
        self.assertEqual([each[2:] for each in dashed], [["13 26", "0"], ["13 26", "-13"], ["13 26", "-26"]])

    def test_each_route_that_is_drawn_has_a_profile_with_distances_and_what_radar_sees(self):
        self.open("routes.html")
        self.assertEqual(self.of("[...document.querySelectorAll('#profiles svg > text:first-child')].map(each => each.textContent)"), ["first", "second"])
        for part, least in ((".tick", 6), (".seen", 10), (".ground", 1), (".way", 1)):
            self.assertGreaterEqual(self.of(f"document.querySelector('#profiles svg').querySelectorAll('{part}').length"), least)

    def test_the_map_names_all_that_is_on_it_and_names_stay_names(self):
        self.open("routes.html")
        self.assertEqual(self.of("document.scripts.length"), 2)
        names = self.of("[...document.querySelectorAll('#map .halo')].map(each => each.textContent)")
        for name in ("Start", "Goal", "Reserve", "Alpha", "Delta", "Sierra", "10 km", "</text><script>alert(1)</script>&"):
            self.assertIn(name, names)

    def test_a_phone_shows_all_of_it_without_scrolling_sideways(self):
        self.open("routes.html", width=360, height=740)
        self.assertLessEqual(self.of("document.documentElement.scrollWidth"), 360)


if __name__ == "__main__":
    if not headless_chromium.installed():
        print("Chromium, its driver or python3-selenium is not installed")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
