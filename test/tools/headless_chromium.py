"""A page in headless Chromium, by its WebDriver and its DevTools protocol."""

import json
import os
import shutil

try:
    from selenium import webdriver
except ImportError:
    webdriver = None


class PageError(Exception):
    """A script of the page has failed."""


class Page:
    """One page of a browser of its own."""

    def __init__(self, width=1280, height=900, patience_s=60):
        options = webdriver.ChromeOptions()
        for argument in ("headless", "no-sandbox", "disable-gpu", "no-first-run", "disable-background-networking", "disable-dev-shm-usage"):
            options.add_argument(f"--{argument}")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self._browser = webdriver.Chrome(options=options)
        self._browser.set_page_load_timeout(patience_s)
        self._browser.set_script_timeout(patience_s)
        self.resize(width, height)

    def __exit__(self, *_):
        self._browser.quit()

    def complaints(self):
        """What scripts have thrown, and written to the console, since this was asked last."""
        return self._browser.get_log("browser")

    def resize(self, width, height):
        self._ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def open(self, file):
        self._browser.get("file://" + os.path.abspath(file))

    def prefer(self, scheme):
        """`light` or `dark`, as people set it for all that they look at."""
        self._ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def value(self, expression):
        """Of an expression in JavaScript; a promise is waited for."""
        answer = self._ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise PageError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def until(self, condition):
        """Waits until an expression in JavaScript is true, which is looked at once a frame."""
        self.value("new Promise(done => { const look = () => %s ? done() : requestAnimationFrame(look); look(); })" % condition)

    def middle_of(self, selector):
        """Of an element, in the window, into which it is scrolled."""
        return self.value("""(async () => {
            const element = document.querySelector(%s);
            element.scrollIntoView({block: "center", behavior: "instant"});
            await new Promise(requestAnimationFrame);
            const box = element.getBoundingClientRect();
            return [box.x + box.width / 2, box.y + box.height / 2];
        })()""" % json.dumps(selector))

    def click(self, selector):
        self.click_at(*self.middle_of(selector))

    def click_at(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self._ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def press(self, key, code):
        for kind in ("rawKeyDown", "keyUp"):
            self._ask("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code)

    def printed(self):
        """As PDF, in base 64."""
        return self._ask("Page.printToPDF", printBackground=True, preferCSSPageSize=True)["data"]

    def _ask(self, method, **parameters):
        return self._browser.execute_cdp_cmd(method, parameters)


def installed():
    return webdriver is not None and shutil.which("chromedriver") is not None
