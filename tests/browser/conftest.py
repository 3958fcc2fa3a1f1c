"""A browser, and JupyterLab in it, started once for all tests of this folder; no request leaves the machine.

Screenshots are made only where MOCAP_ARTEFACTS names a folder to keep them in: each takes half a second.
"""

import contextlib
import json
import os
import shlex
import shutil
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from functools import partial
from pathlib import Path
from urllib.parse import urlsplit

import pytest

LAB = shlex.split("""--ServerApp.ip=127.0.0.1 --ServerApp.port_retries=0 --ServerApp.open_browser=False
--ServerApp.allow_root=True --IdentityProvider.token= --LabApp.news_url=None
--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate --LabApp.extension_manager=readonly
--LabApp.expose_app_in_browser=True""")
SETTINGS = {
    "notebook-extension/tracker": {"windowingMode": "none"},  # cells out of view are in the page as well
    "apputils-extension/notification": {"fetchNews": "false"},
}
CHROMIUM = shlex.split("""--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-sync
--disable-background-networking --disable-component-update""")
CHROMIUM += ["--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1"]
PROGRAMS = ("chromium-headless-shell", "chromium", "chromium-browser")
FLAT = ["--disable-software-rasterizer"]
shaded = pytest.mark.parametrize("browser", [[]], indirect=True, ids=["shaded"])


def wait_until(what, seconds=120.0):
    """Call `what` until it returns something true, and return that."""
    end = time.monotonic() + seconds
    while not (answer := what()):
        assert time.monotonic() < end, f"not within {seconds} s"
        time.sleep(0.05)
    return answer


def keep(page, name):
    """Keep a screenshot for whoever wants to look."""
    if folder := os.environ.get("MOCAP_ARTEFACTS"):
        page.screenshot(path=Path(folder) / f"{name}.png")


def drag(page, *places, steps=8, button="left"):
    """Drag the mouse from the first place over all others, and let go."""
    page.mouse.move(*places[0])
    page.mouse.down(button=button)
    for place in places[1:]:
        page.mouse.move(*place, steps=steps)
    page.mouse.up(button=button)


def fingers_on(page, part):
    """Return a function that lets fingers touch a part, each along its way [(x, y), ...], and lift off."""
    session = page.context.new_cdp_session(page)
    session.send("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})

    def touch(*ways):
        box = page.locator(part).bounding_box()
        for number, places in enumerate(zip(*ways, strict=True)):
            points = [{"id": k, "x": box["x"] + x, "y": box["y"] + y} for k, (x, y) in enumerate(places)]
            kind = "touchMove" if number else "touchStart"
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    return touch


@pytest.fixture(scope="package")  # not "session": other tests must not find Playwright's event loop running
def browser(request):
    """Start a browser, without WebGL unless a test is `shaded`: strokes take two thirds of the work.

    The shell is Chromium without windows: it opens a page in a third of the work.
    """
    program = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if program is None:
        pytest.skip("no Chromium here: apt-get install chromium-headless-shell")
    playwright = pytest.importorskip("playwright.sync_api", reason="pip install '.[ci]'")
    with playwright.sync_playwright() as p:
        chromium = p.chromium.launch(
            executable_path=program, args=[*CHROMIUM, *getattr(request, "param", FLAT)]
        )
        yield chromium
        chromium.close()


def is_error(message):
    """Whether a message is an error; JupyterLab always fails to load pictures attached to cells at first."""
    return message.type == "error" and "net::ERR_UNKNOWN_URL_SCHEME" not in message.text


@contextlib.contextmanager
def watched_page(browser, **screen):
    """Open a fresh page; yield it, and a list of its faults: requests that leave the machine, and errors."""
    context = browser.new_context(**{"viewport": {"width": 1200, "height": 900}} | screen)
    page, faults = context.new_page(), []

    def stay(asked):  # what leaves finds no host
        at = urlsplit(asked.url)
        if at.scheme in ("http", "https", "ws", "wss") and at.hostname != "127.0.0.1":
            faults.append(f"a request for {asked.url}")

    page.on("request", stay)
    page.on("websocket", stay)
    page.on("console", lambda message: faults.append(message.text) if is_error(message) else None)
    page.on("pageerror", lambda error: faults.append(str(error)))
    yield page, faults
    context.close()


PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
on_a_phone = pytest.mark.parametrize("page", [PHONE], indirect=True, ids=["phone"])
without_scripts = pytest.mark.parametrize(
    "page", [{"java_script_enabled": False}], indirect=True, ids=["still"]
)
PICTURES = """() => {
  const root = document.querySelector(".mocap-player, .mocap-inspector");
  return (root?.player ?? root?.inspector)?.pictures > 0;
}"""


@pytest.fixture
def page(browser, request):
    """Yield a fresh page, which a test may ask to be of another kind; afterwards it must have no faults."""
    with watched_page(browser, **getattr(request, "param", {})) as (page, faults):
        yield page
        keep(page, request.node.name)
    assert faults == []


@pytest.fixture
def shown(page, tmp_path):
    """Return a function that shows the page of a player or an inspector, and waits for its first picture."""

    def show(it, **media):
        page.emulate_media(**media)
        file = tmp_path / "page.html"
        file.write_text(it.page(), "utf-8")
        page.goto(file.as_uri())
        wait_until(lambda: page.evaluate(PICTURES))
        return page

    return show


@pytest.fixture
def resting(shown):
    """Return a function that shows such a page, where nothing moves by itself."""
    return partial(shown, reduced_motion="reduce")


@pytest.fixture(scope="package")
def lab(tmp_path_factory):
    """Start JupyterLab on a free port with folders of its own; yield its address, and the notebooks'."""
    pytest.importorskip("jupyterlab", reason="pip install '.[notebooks]'")
    home = tmp_path_factory.mktemp("lab")
    notebooks = home / "notebooks"
    notebooks.mkdir()
    for name, settings in SETTINGS.items():
        file = home / "settings" / "@jupyterlab" / f"{name}.jupyterlab-settings"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(settings))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    own = {
        "JUPYTER_CONFIG_DIR": home / "config",
        "JUPYTER_DATA_DIR": home / "data",
        "JUPYTER_RUNTIME_DIR": home / "runtime",
        "JUPYTERLAB_SETTINGS_DIR": home / "settings",
        "JUPYTERLAB_WORKSPACES_DIR": home / "workspaces",
        "PYTHONPATH": Path(__file__).parents[2],
    }
    command = [sys.executable, "-m", "jupyterlab", *LAB, f"--ServerApp.port={port}", str(notebooks)]
    with (home / "log").open("w") as log:
        server = subprocess.Popen(
            command, env=os.environ | {k: str(v) for k, v in own.items()}, stdout=log, stderr=log
        )
    try:
        address = f"http://127.0.0.1:{port}"
        wait_until(lambda: answers(address + "/api/status"), 60)
        yield address, notebooks
    finally:
        server.terminate()
        server.wait(20)


def answers(address):
    with contextlib.suppress(urllib.error.URLError, ConnectionError):
        return urllib.request.urlopen(address, timeout=2).status == 200
    return False


def run_notebook(lab, page, notebook, name):
    """Open a notebook, run all of it, and wait for the end."""
    address, folder = lab
    (folder / name).write_text(notebook)
    page.goto(f"{address}/lab/tree/{name}?reset")
    kernel = "window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel?.status"
    wait_until(lambda: page.evaluate(kernel) == "idle", 60)
    page.evaluate("jupyterapp.commands.execute('application:toggle-left-area')")
    page.evaluate("window.ran = jupyterapp.commands.execute('notebook:run-all-cells').then(() => 'ran')")
    assert page.evaluate("window.ran") == "ran"
    wait_until(lambda: page.evaluate(kernel) == "idle", 60)


@pytest.fixture
def run(lab, page):
    """Return a function of a notebook and its file's name that runs all of it on the page."""
    return partial(run_notebook, lab, page)
