"""Headless Chromium, spoken to over a pipe with its DevTools protocol; nothing but the standard
library.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from types import TracebackType
from typing import Any, Self

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-extensions",
    "--disable-sync",
    "--no-first-run",
    "--no-default-browser-check",
    "--hide-scrollbars",
    "--remote-debugging-pipe",
)
PATIENCE = 60.0  # seconds


class NoBrowser(Exception):
    """There is no Chromium, or it does not answer."""


def find() -> str:
    """The path of Chromium."""
    for name in NAMES:
        if path := shutil.which(name):
            return path
    raise NoBrowser("no Chromium; install the system's package 'chromium'")


class Browser:
    """One page of a headless browser; a context manager that ends it."""

    def __init__(self) -> None:
        self._profile = tempfile.mkdtemp(prefix="look-")
        their_input, self._commands = os.pipe()
        self._answers, their_output = os.pipe()
        # Chromium reads commands from descriptor 3 and writes answers to descriptor 4.
        shell = f'exec "$0" "$@" 3<&{their_input} 4>&{their_output}'
        self._process = subprocess.Popen(
            [
                "bash",
                "-c",
                shell,
                find(),
                *FLAGS,
                f"--user-data-dir={self._profile}",
                "about:blank",
            ],
            pass_fds=(their_input, their_output),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(their_input)
        os.close(their_output)
        os.set_blocking(self._answers, False)
        self._rest, self._number = b"", 0
        self.events: list[dict[str, Any]] = []
        self._session: str | None = None
        targets = self.call("Target.getTargets")["targetInfos"]
        page = next(t["targetId"] for t in targets if t["type"] == "page")
        attached = self.call("Target.attachToTarget", targetId=page, flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Network", "Log", "Runtime"):
            self.call(f"{domain}.enable")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._process.terminate()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._commands)
        os.close(self._answers)
        shutil.rmtree(self._profile, ignore_errors=True)

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send one command and wait for its answer; events on the way are kept."""
        self._number += 1
        message: dict[str, Any] = {"id": self._number, "method": method, "params": parameters}
        if self._session is not None:
            message["sessionId"] = self._session
        try:
            os.write(self._commands, json.dumps(message).encode() + b"\0")
        except BrokenPipeError:
            raise NoBrowser("Chromium ended") from None
        while True:
            found = self._next()
            if found.get("id") == self._number:
                if "error" in found:
                    raise NoBrowser(f"{method}: {found['error']}")
                result: dict[str, Any] = found["result"]
                return result
            self.events.append(found)

    def until(self, event: str) -> None:
        """Wait for an event that has not been seen since the events were last cleared."""
        while not any(each.get("method") == event for each in self.events):
            self.events.append(self._next())

    def evaluate(self, expression: str) -> Any:
        """The value of an expression in the page."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        return answer["result"].get("value")

    def _next(self) -> dict[str, Any]:
        end = time.monotonic() + PATIENCE
        while b"\0" not in self._rest:
            try:
                chunk = os.read(self._answers, 1 << 16)
                if not chunk:
                    raise NoBrowser("Chromium ended")
                self._rest += chunk
            except BlockingIOError:
                if time.monotonic() > end:
                    raise NoBrowser("Chromium does not answer") from None
                time.sleep(0.01)
        text, _, self._rest = self._rest.partition(b"\0")
        message: dict[str, Any] = json.loads(text)
        return message


def open_page(browser: Browser, path: Path, width: int, scheme: str) -> list[str]:
    """Open a file at this width, light, dark or as in print; what is wrong with it, in words."""
    browser.call(
        "Emulation.setDeviceMetricsOverride",
        width=width,
        height=900,
        deviceScaleFactor=1,
        mobile=width < 600,
    )
    printed = scheme == "print"
    colors = {"name": "prefers-color-scheme", "value": "light" if printed else scheme}
    browser.call(
        "Emulation.setEmulatedMedia", media="print" if printed else "screen", features=[colors]
    )
    browser.events.clear()
    address = path.resolve().as_uri()
    browser.call("Page.navigate", url=address)
    browser.until("Page.loadEventFired")
    wrong = [said for event in browser.events if (said := _complaint(event, address))]
    for state in ("folded", "open"):
        wide, view = browser.evaluate("[document.documentElement.scrollWidth, innerWidth]")
        if wide > view:
            wrong.append(f"{state}: the page is {wide} pixels wide, the window {view}")
        browser.evaluate("document.querySelectorAll('details').forEach(d => { d.open = true })")
    browser.evaluate("document.querySelectorAll('details').forEach(d => { d.open = false })")
    wrong += [f"{each}" for each in browser.evaluate(_PRINTED if printed else _UNTOLD) or ()]
    dark = browser.evaluate("matchMedia('(prefers-color-scheme: dark)').matches")
    if dark != (scheme == "dark"):
        wrong.append(f"the color scheme is not {scheme}")
    return wrong


# A box that can be scrolled sideways says so, and no other box does.
_UNTOLD = """
[...document.querySelectorAll('.box')].filter(box => {
  const told = getComputedStyle(box, '::before').display !== 'none';
  return box.offsetWidth && told !== box.scrollWidth > box.clientWidth;
}).map(box => `${box.getAttribute('aria-label')}: wide and not told so, or the reverse`)
"""
# Paper cannot be scrolled.
_PRINTED = """
[...document.querySelectorAll('.box')].filter(box => box.scrollWidth > box.clientWidth + 1)
  .map(box => `${box.getAttribute('aria-label')}: wider than the paper`)
"""
_CLOSED = """
[...new Set([...document.querySelectorAll('a[href^="#"]')].map(link => link.hash))].filter(hash => {
  document.querySelectorAll('details').forEach(panel => { panel.open = false });
  location.hash = hash;
  const panel = document.getElementById(hash.slice(1)).closest('details');
  return panel && !panel.open;
})
"""


def closed_panels(browser: Browser, path: Path) -> list[str]:
    """Which links within a page lead into a panel that does not open."""
    browser.events.clear()
    browser.call("Page.navigate", url=path.resolve().as_uri())
    browser.until("Page.loadEventFired")
    found: list[str] = browser.evaluate(_CLOSED)
    return found


def _complaint(event: dict[str, Any], address: str) -> str:
    """What an event says against the page; empty if nothing."""
    said = event.get("params", {})
    match event.get("method"):
        case "Network.requestWillBeSent":
            url = said["request"]["url"]
            if url != address and not url.startswith("data:"):
                return f"request for {url}"
        case "Log.entryAdded" if said["entry"]["level"] == "error":
            return f"console: {said['entry']['text']}"
        case "Runtime.exceptionThrown":
            return f"exception: {said['exceptionDetails'].get('text', '')}"
        case "Runtime.consoleAPICalled" if said["type"] in ("error", "assert"):
            return f"console: {said['args']}"
    return ""
