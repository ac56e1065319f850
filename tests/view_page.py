"""A recorded run, servers and a browser for the tests of the viewer."""

import atexit
import http.server
import re
import shutil
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path
from typing import Any

from hedon import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.view.export import export
from hedon.view.index import RunIndex
from hedon.view.live import live_world
from hedon.view.server import Server
from hedon.view.story import story

CHROMIUM = Path("/usr/bin/chromium")
FLAGS = ["--no-sandbox", "--use-gl=swiftshader", "--enable-unsafe-swiftshader"]
SIZE = {"width": 1280, "height": 720}
SIZES = {1400: 860, 1024: 768, 390: 844}
"""Page widths of a desktop, a tablet and a phone, and their heights."""
GROUNDS = ("light", "dark")


def record(folder: Path, steps: int) -> Path:
    """Records a run with two kinds of food and a frame every 64 steps."""
    run(RunPlan(load_config("poison"), (1,), steps, folder, 1, 64))
    return folder


@contextmanager
def serving(server: Any) -> Iterator[Any]:
    """Runs a server in a separate thread."""
    thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
    thread.start()
    try:
        yield server
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


def run_server(folder: Path, *others: Path) -> Server:
    """A server like that of `hedon view RUN [OTHER...]`."""
    index = RunIndex(folder, others)
    page = {"run": True, "worlds": [live_world(load_config("poison"), "poison")]}
    return Server({"page": lambda: page, "run": index.describe}, index.files)


def live_server(source: str) -> Server:
    """A server like that of `hedon view --live SOURCE`, without the other presets, which take seconds to describe."""
    page = {"run": False, "worlds": [live_world(load_config(source), source)]}
    return Server({"page": lambda: page}, dict)


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:  # noqa: A002
        """Prints nothing."""


def site_server(site: Path) -> http.server.ThreadingHTTPServer:
    """A generic server: it sends the files of a folder, without special headers."""
    return http.server.ThreadingHTTPServer(("127.0.0.1", 0), partial(_Quiet, directory=site))


def demo_server() -> http.server.ThreadingHTTPServer:
    """A server for the `hedon view RUN --export` site of a long run with sparse frames, made once per process."""
    return site_server(_demo_site())


@cache
def _demo_site() -> Path:
    folder = Path(tempfile.mkdtemp(prefix="hedon-demo-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    small = load_config("baseline", overrides=["population.capacity=80", "food.normal.capacity=50"])
    run(RunPlan(small, (1,), 53_248, folder / "run", 1, 1024))
    index = RunIndex(folder / "run")
    data = {"page": {"run": True, "worlds": []}, "run": index.describe()}
    export(folder / "site", data, index.files())
    return folder / "site"


class Watched:
    """A browser page that records its errors and its requests to other hosts."""

    def __init__(self, page: Any, link: str) -> None:
        self.page = page
        self.faults: list[str] = []
        page.on("console", lambda message: message.type == "error" and self.faults.append(message.text))
        page.on("pageerror", lambda error: self.faults.append(str(error)))
        page.on("request", lambda request: self._check(request.url, link))
        page.goto(link)
        self.until("window.hedon && hedon.pictures > 0")

    def _check(self, url: str, link: str) -> None:
        origin = "/".join(link.split("/")[:3]) + "/"
        if not url.startswith((origin, "data:", f"blob:{origin}")):
            self.faults.append(f"asked {url}")

    def until(self, condition: str, seconds: float = 120.0) -> None:
        """Waits by polling, since the page's security policy forbids code from strings."""
        end = time.monotonic() + seconds
        while not self.page.evaluate(f"!!({condition})"):
            assert time.monotonic() < end, f"never: {condition}; {self.faults}"
            time.sleep(0.05)

    def get(self, code: str) -> Any:
        """The value of an expression evaluated in the page."""
        return self.page.evaluate(code)

    def rest_at(self, step: int) -> None:
        """Stops at a recorded step and waits until it is drawn."""
        self.get(f"(hedon.play(false), hedon.seek({step}))")
        self.until(f"hedon.frame && hedon.frame.step === {step}")
        drawn = self.get("hedon.pictures")
        self.until(f"hedon.pictures > {drawn} + 2")


def numbers(text: str) -> list[float]:
    """The numbers in a text of the page, written with commas and a true minus sign."""
    assert not re.search(r"(?<![\w-])-\d", text), f"a hyphen before a number: {text}"
    found = re.findall(r"\N{MINUS SIGN}?\d[\d,]*\.?\d*", text)
    return [float(each.replace(",", "").replace("\N{MINUS SIGN}", "-")) for each in found]


def sized(width: int, ground: str = "light") -> dict[str, Any]:
    """Browser options for one of the `SIZES`; the phone has a touch screen."""
    return {"viewport": {"width": width, "height": SIZES[width]}, "color_scheme": ground, "has_touch": width == 390}


def run_live(watched: Watched, steps: int) -> None:
    """Lets a live world run its first steps and learn."""
    watched.get("hedon.play(false)")
    watched.until("!hedon.source.busy")
    while (done := watched.get("hedon.source.last")) < steps or watched.get("hedon.source.learning"):
        watched.get(f"hedon.source.advance({steps - done}, 5000)")
        watched.until("!hedon.source.busy")
    watched.until("hedon.source.digest() !== ''")


def story_server() -> Server:
    """A server like that of `hedon view --story`, without the instrument's presets, which take seconds to describe."""
    told = story()
    return Server({"page": lambda: {"run": False, "worlds": []}, "story": lambda: told}, dict)
