"""The page of `mocap steer`: keys, a gamepad, mouse and fingers steer, and the walk is recorded."""

import math
import threading
from contextlib import contextmanager

import numpy as np
import pytest

from mocap import load
from mocap.body.planar import on_ground
from mocap.quality.seam_measures import foot_sliding
from mocap.widgets.steering_server import SteeringServer
from mocap.widgets.walking_page import bundled_graph
from tests.browser.conftest import PHONE, fingers_on, on_a_phone, wait_until, watched_page

IT = "document.body.steering"
NEARLY = math.radians(20)  # from a heading, as in `mocap.steering`


@pytest.fixture(scope="module")
def graph():
    return bundled_graph()


@contextmanager
def serving(graph):
    """Serve the page in a thread; the motions that it records are kept."""
    with SteeringServer(graph) as server:
        server.motions = []
        server.recorded = lambda motion: server.motions.append(motion) or "Kept."
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield server
        server.shutdown()
        thread.join()


@pytest.fixture(scope="module")
def server(graph):
    with serving(graph) as server:
        yield server


def opened(page, server):
    page.goto(server.address)
    wait_until(lambda: page.evaluate(f"{IT}?.pictures > 0"))
    return page


@pytest.fixture
def steering(page, server):
    return opened(page, server)


def command(page):
    return page.evaluate(f"{IT}.command")


def walk(page, seconds):
    """Wait until the figure has walked for some seconds more."""
    end = page.evaluate(f"{IT}.link.time") + seconds
    wait_until(lambda: page.evaluate(f"{IT}.link.time") >= end)


def headings(motion):
    """Return the direction of the last third of a second, at each frame after it; radians."""
    track = on_ground(motion.root_positions)
    back = round(motion.fps / 3)
    return np.angle(track[back:] - track[:-back])


def delay(motion, frame, heading):
    """Return the seconds from a frame of a motion until it obeys a heading."""
    off = np.abs(np.angle(np.exp(1j * (headings(motion) - heading))))
    (obeyed,) = np.nonzero(off < NEARLY)
    shown = obeyed + round(motion.fps / 3)
    return (shown[shown > frame][0] - frame) / motion.fps


def recorded_turn(page, folder, key, turned):
    """Record a walk in which another key is held from a frame on.

    Return its .bvh, read, the number of its first frame, and that of the frame of the key.
    """
    page.keyboard.down(key)
    walk(page, 3)
    page.keyboard.press("Space")
    walk(page, 1)
    page.evaluate(f"addEventListener('keydown', () => (window.keyFrame = {IT}.link.frame), {{ once: true }})")
    page.keyboard.up(key)
    page.keyboard.down(turned)
    start = page.evaluate(f"[{IT}.from, window.keyFrame]")
    walk(page, 3)
    with page.expect_download() as download:
        page.keyboard.press("Space")
    page.keyboard.up(turned)
    file = folder / download.value.suggested_filename
    download.value.save_as(file)
    return load(file), *start


def test_a_held_key_turns_the_figure_and_the_recording_is_a_bvh_of_it(steering, server, tmp_path):
    assert not steering.evaluate(f"{IT}.playing")  # nothing moves before the first command
    file, first, key = recorded_turn(steering, tmp_path, "ArrowUp", "ArrowLeft")
    motion = server.motions[-1]
    frame = key - first
    assert np.cos(headings(file)[frame - 10]) > math.cos(NEARLY)
    assert np.cos(headings(file)[-1] - math.pi / 2) > math.cos(NEARLY)
    np.testing.assert_allclose(file.root_positions, motion.root_positions, atol=1e-5)
    assert len(file) >= 4 * 30 and file.fps == pytest.approx(30)
    assert max(slide.distance for slide in foot_sliding(motion)) <= 1.0  # cm
    assert steering.get_by_role("link", name="steered-1.bvh").is_visible()
    assert "Kept." in steering.get_by_role("status").inner_text()


@pytest.mark.benchmark
def test_a_key_is_obeyed_within_a_second(steering, server, tmp_path, monkeypatch):
    """The delay of quarter turns, in the frames of recordings, with what the page adds to the control's."""
    replies = []
    answer = server.session.walk

    def logged(request):
        reply = answer(request)
        replies.append((request["command"][0], reply["first"]))
        return reply

    monkeypatch.setattr(server.session, "walk", logged)
    whole, added = [], []
    for keys, heading in [("Up Left", 90), ("Left Down", 180), ("Down Right", -90), ("Right Up", 0)]:
        key, turned = (f"Arrow{name}" for name in keys.split())
        replies.clear()
        file, first, frame = recorded_turn(steering, tmp_path, key, turned)
        whole.append(delay(file, frame - first, math.radians(heading)))
        obeying = min(start for angle, start in replies if math.cos(angle - math.radians(heading)) > 0.99)
        added.append((obeying - frame) / file.fps)
    trips = steering.evaluate(f"{IT}.link.trips")
    print("whole delays", np.round(whole, 2), "of the page", np.round(added, 2), "ms", np.round(trips))
    assert np.mean(whole) <= 1.0


def test_shift_is_the_faster_pace_two_keys_walk_between_and_no_key_stands(steering):
    steering.keyboard.down("w")
    steering.keyboard.down("d")
    wait_until(lambda: math.cos(command(steering)[0] + math.pi / 4) > 0.999)
    usual = command(steering)
    steering.keyboard.down("Shift")
    wait_until(lambda: command(steering)[2] == "jog" and command(steering)[1] > usual[1] + 0.5)
    for key in ("Shift", "w", "d"):
        steering.keyboard.up(key)
    wait_until(lambda: command(steering)[1:] == [0, ""])
    steering.keyboard.press("p")
    assert steering.get_by_role("button", name="Pause").get_attribute("aria-pressed") == "true"
    time = steering.evaluate(f"{IT}.link.time")
    steering.wait_for_timeout(200)
    assert steering.evaluate(f"{IT}.link.time") == time


def test_keys_mean_the_same_on_the_picture_from_every_side(steering):
    steering.get_by_role("combobox", name="view").select_option("side")
    steering.locator("#stage").focus()
    steering.keyboard.down("ArrowUp")
    wait_until(lambda: math.cos(command(steering)[0] + math.pi / 2) > 0.999)
    steering.keyboard.down("q")
    wait_until(lambda: math.cos(command(steering)[0] + math.pi / 2) < 0.95)  # the view turns, and the way


def test_a_slider_and_a_list_keep_their_keys(steering):
    slider = steering.get_by_role("slider", name="speed")
    before = float(slider.input_value())
    slider.focus()
    steering.keyboard.press("ArrowRight")
    assert float(slider.input_value()) == pytest.approx(before + 0.05)
    assert command(steering)[1] == 0
    steering.get_by_role("combobox", name="kind").select_option("sneak")
    steering.locator("#stage").focus()
    steering.keyboard.down("ArrowUp")
    wait_until(lambda: command(steering)[2] == "sneak" and command(steering)[1] < before)


def test_a_pressed_place_on_the_ground_is_walked_to(steering):
    box = steering.locator("#stage").bounding_box()
    steering.mouse.move(box["x"] + 0.2 * box["width"], box["y"] + 0.6 * box["height"])
    steering.mouse.down()
    wait_until(lambda: math.sin(command(steering)[0]) > 0.5 and command(steering)[1] > 0)
    steering.mouse.move(box["x"] + 0.8 * box["width"], box["y"] + 0.6 * box["height"])
    wait_until(lambda: math.sin(command(steering)[0]) < -0.5)
    steering.mouse.up()
    goal = steering.evaluate(f"{IT}.hands.goal")
    wait_until(lambda: command(steering)[1] == 0)
    x, _, z = steering.evaluate(f"Array.from({IT}.walker.pose({IT}.link.time)).slice(0, 3)")
    assert math.hypot(goal[0] - x, goal[1] - z) < 1.5


PAD = """(axes, pressed) => {
  const buttons = Array.from({ length: 17 }, (_, k) => ({ pressed: pressed.includes(k) }));
  navigator.getGamepads = () => [{ connected: true, axes, buttons }];
}"""


def hold(page, axes, *buttons):
    page.evaluate(f"([axes, pressed]) => ({PAD})(axes, pressed)", [axes, buttons])


def test_a_gamepad_walks_records_and_turns_the_view(steering, server):
    hold(steering, [-1, 0, 0, 0])
    wait_until(lambda: math.cos(command(steering)[0] - math.pi / 2) > 0.999)
    whole = command(steering)[1]
    hold(steering, [-0.6, 0, 0, 0], 0)
    wait_until(lambda: 0 < command(steering)[1] < whole)
    wait_until(lambda: steering.get_by_role("button", name="Stop").is_visible())
    walk(steering, 1)
    hold(steering, [-0.6, 0, 0, 0])
    wait_until(lambda: steering.evaluate(f"{IT}.hands.down.size === 0"))
    recordings = len(server.motions)
    with steering.expect_download():
        hold(steering, [0.1, 0.1, 0, 0], 0)
    assert len(server.motions) == recordings + 1
    wait_until(lambda: command(steering)[1] == 0)
    yaw = steering.evaluate(f"{IT}.camera.yaw")
    hold(steering, [0, 0, 1, 0])
    wait_until(lambda: steering.evaluate(f"{IT}.camera.yaw") > yaw + 0.2)


@on_a_phone
def test_a_finger_steers_on_a_phone(steering):
    assert steering.evaluate("document.documentElement.scrollWidth") <= PHONE["viewport"]["width"]
    for button in steering.get_by_role("button").all():
        assert button.bounding_box()["height"] >= 44
    fingers_on(steering, "#stage")([(60, 420), (50, 420), (40, 420)])
    wait_until(lambda: math.sin(command(steering)[0]) > 0.5 and command(steering)[1] > 0)
    assert steering.evaluate("scrollY") == 0


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_is_dark_where_the_reader_wants_it(steering, scheme):
    steering.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    dark = steering.evaluate("getComputedStyle(document.querySelector('h1')).color") == "rgb(238, 238, 238)"
    assert dark == (scheme == "dark")
    assert not steering.evaluate(f"{IT}.playing")


def test_names_stand_for_screen_readers(steering):
    assert steering.get_by_role("application", name="A figure that you steer.").is_visible()
    assert steering.get_by_role("toolbar", name="The figure").is_visible()
    assert steering.get_by_role("button", name="Record").is_enabled()


def test_when_the_server_has_gone_the_page_says_so(browser, graph):
    with watched_page(browser) as (page, _):  # the browser reports the lost connection as a fault
        with serving(graph) as server:
            opened(page, server)
            page.keyboard.down("ArrowUp")
            wait_until(lambda: page.evaluate(f"{IT}.playing"))
        said = page.get_by_role("status")
        wait_until(lambda: said.inner_text() == "mocap steer has ended. Start it again: it opens a new page.")
        assert page.get_by_role("button", name="Record").is_disabled()
        assert not page.evaluate(f"{IT}.playing")
