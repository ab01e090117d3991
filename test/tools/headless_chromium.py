"""A page in headless Chromium, spoken to by its DevTools protocol over pipes."""

import json
import os
import select
import shutil
import subprocess
import tempfile
import time


class PageError(Exception):
    """The browser refused something, or did not answer in time."""


class Page:
    """One page of a browser of its own. What its scripts throw, and what they write to the console, is in `complaints`."""

    def __init__(self, width=1280, height=900, patience_s=60):
        self._patience_s = patience_s
        self._folder = tempfile.mkdtemp(prefix="skein-chromium-")
        theirs_in, self._out = os.pipe()
        self._in, theirs_out = os.pipe()
        # Chromium reads from 3 and writes to 4, which may be ends of these pipes.
        high_in, high_out = [_at_least(10, end) for end in (theirs_in, theirs_out)]

        def connect():
            os.dup2(high_in, 3)
            os.dup2(high_out, 4)

        try:
            self._browser = subprocess.Popen(
                ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
                 "--disable-dev-shm-usage", f"--user-data-dir={self._folder}", "--remote-debugging-pipe"],
                preexec_fn=connect, pass_fds=(3, 4), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        finally:
            os.close(high_in)
            os.close(high_out)
        self._text = b""
        self._number = 0
        self._session = None
        self.complaints = []
        self._events = []
        target = self._ask("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self._ask(f"{domain}.enable")
        self.resize(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._session = None
            self._ask("Browser.close")
        except (PageError, OSError):
            self._browser.kill()
        try:
            self._browser.wait(self._patience_s)
        except subprocess.TimeoutExpired:
            self._browser.kill()
            self._browser.wait()
        os.close(self._in)
        os.close(self._out)
        shutil.rmtree(self._folder, ignore_errors=True)

    def resize(self, width, height):
        self._ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def open(self, file):
        self._events.clear()
        self._ask("Page.navigate", url="file://" + os.path.abspath(file))
        deadline = time.monotonic() + self._patience_s
        while "Page.loadEventFired" not in self._events:
            self._read(deadline)

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

    def screenshot(self, whole=True):
        """As PNG, in base 64."""
        return self._ask("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]

    def printed(self):
        """As PDF, in base 64."""
        return self._ask("Page.printToPDF", printBackground=True, preferCSSPageSize=True)["data"]

    def _ask(self, method, **parameters):
        self._number += 1
        number = self._number
        message = {"id": number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + self._patience_s
        while True:
            answer = self._read(deadline)
            if answer.get("id") == number:
                if "error" in answer:
                    raise PageError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def _read(self, deadline):
        while b"\0" not in self._text:
            ready, _, _ = select.select([self._in], [], [], max(0.0, deadline - time.monotonic()))
            part = os.read(self._in, 1 << 16) if ready else b""
            if not part:
                raise PageError("Chromium " + ("has ended" if ready else "did not answer in time"))
            self._text += part
        text, self._text = self._text.split(b"\0", 1)
        message = json.loads(text)
        method, parameters = message.get("method"), message.get("params", {})
        if method:
            self._events.append(method)
        if method == "Runtime.exceptionThrown":
            self.complaints.append(parameters["exceptionDetails"])
        elif method == "Runtime.consoleAPICalled":
            self.complaints.append(parameters["args"])
        elif method == "Log.entryAdded":
            self.complaints.append(parameters["entry"])
        elif method == "Page.javascriptDialogOpening":
            self.complaints.append(parameters["message"])
        return message


def installed():
    return shutil.which("chromium") is not None


def _at_least(number, end):
    moved = os.dup(end)
    extra = []
    while moved < number:
        extra.append(moved)
        moved = os.dup(end)
    for each in (*extra, end):
        os.close(each)
    return moved
