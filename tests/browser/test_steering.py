"""Steered characters in a browser: mouse, keys and fingers command them, and the pictures keep up."""

import json
import math
from pathlib import Path

import pytest

from tests.browser.conftest import fingers_on, on_a_phone, wait_until
from tests.widgets.steerable import Dot

IT, MODEL = "window.it", "window.model"
FAKE = Path(__file__).with_name("steering_model.js")


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Write a page of three characters, whose Python is a script on it."""
    pytest.importorskip("anywidget")
    from mocap.widgets import steered
    from mocap.widgets.embedding import joined

    live = steered({name: Dot() for name in ("graph", "steps", "matching")}, labels=("", "jog"))
    state = json.dumps({"scene": live.scene, "command": [0, 1.1, ""]})
    start = f"window.model = new Model({state}); window.it = new Steering(document.body.firstChild, model);"
    file = tmp_path_factory.mktemp("steering") / "steering.html"
    file.write_text(
        '<!doctype html><html lang="en"><meta charset="utf-8"><link rel="icon" href="data:,">'
        '<meta name="viewport" content="width=device-width"><body class="mocap-page"><div></div>'
        f'<script type="module">{live._esm}\n{joined(FAKE)}\n{start}</script></body></html>',
        "utf-8",
    )
    return file.as_uri()


@pytest.fixture
def steering(page, written):
    page.goto(written)
    wait_until(lambda: page.evaluate(f"{IT}?.pictures > 0"))
    return page


def command(page):
    return page.evaluate(f"{MODEL}.get('command')")


def press(page, *keys):
    page.locator(".panels").focus()
    for key in keys:
        page.keyboard.down(key)
    for key in keys:
        page.keyboard.up(key)
    return command(page)[0]


def close(a, b):
    return math.cos(a - b) > 1 - 1e-9


def test_keys_command_a_direction_on_the_picture(steering):
    for keys, degrees in [
        (["ArrowUp"], 0),
        (["ArrowLeft"], 90),
        (["s"], 180),
        (["D"], -90),
        (["w", "a"], 45),
        (["ArrowUp", "ArrowRight"], -45),
    ]:
        assert close(press(steering, *keys), math.radians(degrees)), keys
    assert close(press(steering, "q"), math.radians(-30))
    press(steering, "+")
    press(steering, "+")
    assert command(steering)[1] == pytest.approx(1.3)
    for _ in range(9):
        press(steering, "+")
    assert command(steering)[1] == 1.6  # no faster than may be asked for


def test_a_key_that_is_held_while_the_focus_leaves_is_let_go(steering):
    steering.locator(".panels").focus()
    steering.keyboard.down("w")
    steering.evaluate("document.activeElement.blur()")
    steering.keyboard.up("w")  # nothing of the widget hears that
    assert close(press(steering, "a"), math.radians(90))  # and not 45


def test_an_arrow_means_the_same_on_the_picture_from_every_side(steering):
    steering.locator("select.view").select_option("side")
    assert close(press(steering, "ArrowUp"), -math.pi / 2)
    ends = steering.evaluate(f"""() => {{
        const [base, tip] = {IT}.arrow([0, 0, 0]), {{ camera }} = {IT}.panels[0];
        {IT}.draw(0);
        return [base, tip].map(([x, z]) => camera.see(x, 0, z)[0]);
    }}""")
    assert ends[0] == pytest.approx(ends[1], abs=1e-6)  # straight away from the reader


def test_they_walk_from_the_first_command_on_and_the_way_of_a_command_is_said(steering):
    assert not steering.evaluate(f"{IT}.playing")
    assert "obeyed" not in steering.locator("figcaption").first.inner_text()  # nobody has steered yet
    steering.get_by_role("button", name="walk").click()
    steering.keyboard.press("ArrowLeft")  # the button has the focus, and keys steer
    wait_until(lambda: steering.evaluate(f"{IT}.latencies.length"))
    x, _, z = steering.evaluate(place := f"Array.from({IT}.panels[0].walker.pose({IT}.time)).slice(0, 3)")
    later = wait_until(lambda: (now := steering.evaluate(place))[0] > x + 0.2 and now)
    assert later[2] == pytest.approx(z, abs=0.05)  # to the left alone, however long they walked ahead before
    wait_until(lambda: "is under way to Python" in steering.locator(".under").inner_text())
    assert "mean of 2: 1.50 s" in steering.locator("figcaption").first.inner_text()
    press(steering, " ")
    stopped = steering.evaluate(f"{IT}.time")
    steering.wait_for_timeout(200)
    assert steering.evaluate(f"{IT}.time") == stopped


def test_the_mouse_commands_on_the_pad_and_on_the_ground(steering):
    box = steering.locator(".pad").bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    steering.mouse.move(middle[0] - 56, middle[1])
    steering.mouse.down()
    assert close(command(steering)[0], math.pi / 2) and command(steering)[1] == 1.6
    steering.mouse.move(middle[0], middle[1] - 18)
    steering.mouse.up()
    assert close(command(steering)[0], 0) and command(steering)[1] == 0.5
    place = steering.evaluate(f"""() => {{
        const {{ camera, walker, canvas }} = {IT}.panels[2];
        {IT}.toggle(false);
        {IT}.draw(0);
        const [x, , z] = walker.pose({IT}.time), {{ left, top }} = canvas.getBoundingClientRect();
        const [across, down] = camera.pixel(camera.see(x - 1, 0, z));
        return [left + canvas.clientLeft + across, top + canvas.clientTop + down];
    }}""")
    steering.mouse.click(*place)
    assert math.cos(command(steering)[0] + math.pi / 2) > 0.99


@on_a_phone
def test_the_slider_of_a_finger_is_large(steering):
    assert steering.locator(".speed").bounding_box()["height"] >= 44


def test_a_finger_on_the_pad_commands_and_does_not_scroll(steering):
    steering.evaluate("document.body.style.height = '3000px'")
    fingers_on(steering, ".pad")([(60, 60 + 6 * down) for down in range(9)])
    wait_until(lambda: math.cos(command(steering)[0]) < -0.99)
    assert steering.evaluate("scrollY") == 0


def test_a_finger_on_the_ground_commands_when_it_taps_and_scrolls_when_it_moves_up(steering):
    press(steering, "ArrowUp")
    wait_until(lambda: steering.evaluate(f"{IT}.panels[0].walker.frames.length > 0"))
    steering.evaluate("document.body.style.height = '3000px'")
    before, fingers = command(steering), fingers_on(steering, "figure >> nth=0 >> canvas")
    fingers([(20, 200)])
    wait_until(lambda: command(steering) != before)
    before = command(steering)
    fingers([(200, 200 - 9 * step) for step in range(12)])
    wait_until(lambda: steering.evaluate("scrollY") > 50)
    assert command(steering) == before


def test_without_an_answer_time_slows_down_and_stands_and_goes_on_afterwards(steering):
    press(steering, "ArrowUp")
    wait_until(lambda: steering.evaluate(f"{IT}.time") > 1)
    steering.evaluate(f"{MODEL}.silent = true; 0")
    message = steering.locator(".message")
    wait_until(lambda: message.inner_text() == "Python is busy: the figures wait until it answers.")
    stood = steering.evaluate(f"{IT}.time")
    steering.wait_for_timeout(300)
    assert steering.evaluate(f"{IT}.time") - stood < 0.01
    assert steering.evaluate(f"{IT}.ahead") > -1e-9
    assert steering.evaluate(f"{IT}.asked.size") <= 8  # a few questions, not one per picture
    steering.evaluate(f"{MODEL}.speak()")
    wait_until(lambda: steering.evaluate(f"{IT}.time") > stood + 0.3)
    assert message.inner_text() == ""


def test_when_python_has_ended_the_page_says_what_to_do(steering):
    press(steering, "ArrowUp")
    steering.evaluate(f"{MODEL}.tell('comm_live_update')")
    said = steering.locator(".message")
    wait_until(lambda: "run the cell again" in said.inner_text())
    late = "{ view: 0, members: [], notes: ['Too fast.'] }"  # an answer that was under way
    steering.evaluate(f"{MODEL}.tell('msg:custom', {late}, [])")
    assert "run the cell again" in said.inner_text()
    assert not steering.evaluate(f"{IT}.playing")


def test_faults_refusals_and_warnings_are_said(steering):
    steering.evaluate(
        f"{MODEL}.said = {{ member: {{ fault: 'NoWalk: no clip jogs.' }}, notes: ['Too fast.'] }}; 0"
    )
    press(steering, "ArrowUp")
    wait_until(lambda: steering.locator(".fault").first.inner_text() == "NoWalk: no clip jogs.")
    wait_until(lambda: steering.locator(".message").inner_text() == "Too fast.")
    steering.evaluate(f"{MODEL}.said = {{}}; 0")
    press(steering, "ArrowLeft")
    wait_until(lambda: steering.locator(".message").inner_text() == "")
    steering.evaluate(f"{MODEL}.tell('msg:custom', {{ kind: 'refused', why: 'MocapError: no.' }}, [])")
    assert steering.locator(".message.error").inner_text() == "MocapError: no."


def test_nothing_is_asked_while_nobody_looks(steering):
    press(steering, "ArrowUp")
    steering.evaluate("document.body.style.height = '5000px'; scrollTo(0, 4000)")
    wait_until(lambda: not steering.evaluate(f"{IT}.visible"))
    steering.wait_for_timeout(100)
    asked = steering.evaluate(f"{MODEL}.questions.length")
    steering.wait_for_timeout(300)
    assert steering.evaluate(f"{MODEL}.questions.length") == asked
    steering.evaluate("scrollTo(0, 0)")
    wait_until(lambda: steering.evaluate(f"{MODEL}.questions.length") > asked + 2)


def test_a_kind_of_motion_is_chosen(steering):
    steering.get_by_label("kind of motion").select_option("jog")
    assert command(steering)[2] == "jog"


def test_names_stand_for_screen_readers_and_keys_stay_here(steering):
    assert steering.get_by_role("application", name="Figures obey one command").is_visible()
    assert steering.get_by_role("slider", name="speed").is_visible()
    parts = steering.locator(".mocap-steering :is(.panels, button, input, select)")
    assert {part.get_attribute("data-lm-suppress-shortcuts") for part in parts.all()} == {"true"}


@pytest.mark.parametrize(("wide", "scheme"), [(390, "dark"), (1200, "light")])
def test_it_fits_a_phone_and_a_dark_page(steering, wide, scheme):
    steering.set_viewport_size({"width": wide, "height": 844})
    steering.emulate_media(color_scheme=scheme)
    press(steering, "w", "a")
    steering.wait_for_timeout(700)
    assert steering.evaluate("document.documentElement.scrollWidth") <= wide
    box = steering.locator(".pad").bounding_box()
    assert box["y"] + box["height"] <= 844
