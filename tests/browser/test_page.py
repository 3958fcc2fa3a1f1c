"""The page that `Player.page` writes, in a browser: it plays, obeys the reader, and loads nothing."""

import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from walking import generate_walk

from mocap.body import joint_positions, place, resample, rotations
from mocap.datasets import sample
from mocap.widgets.embedding import PICTURE, SCENE, SHADED, joined
from mocap.widgets.player import packed_body, packed_character, play
from mocap.widgets.walk_figure import figure
from tests.browser.conftest import drag, fingers_on, on_a_phone, shaded, wait_until, without_scripts
from tests.strategies import wave

PLAYER = "document.querySelector('.mocap-player').player"

# Draws forty pictures, and counts how often each strokes: a stroke takes time, whatever it strokes.
STROKES = f"""() => {{
    const player = {PLAYER}, counts = [], pen = CanvasRenderingContext2D.prototype, {{ stroke }} = pen;
    player.camera.pitch = PITCH;
    for (let k = 0; k < 40; k++) {{
        player.time = 30 + k / 10;
        counts.push(0);
        pen.stroke = function (...what) {{ counts[k] += 1; return stroke.apply(this, what); }};
        player.draw();
    }}
    pen.stroke = stroke;
    return counts;
}}"""


def twelve(count=12):
    """Give a player of twelve characters, or fewer, that walk for a minute beside each other."""
    way = np.linspace(0, 1, 40)
    walk = resample(generate_walk(np.stack([2 * np.sin(9 * way), 60 * way], axis=1), speed=1.0), 30)
    places = [np.array([1.2 * (k % 4), 0, 1.2 * (k // 4)]) for k in range(count)]
    walks = [replace(walk, root_positions=walk.root_positions + place) for place in places]
    return play(*(replace(one, name=f"member {k}") for k, one in enumerate(walks)), follow=False)


def colours(page):
    """Return the canvas's pixels, shape (height, width, 3)."""
    shot = Image.open(io.BytesIO(page.locator("canvas").screenshot())).convert("RGB")
    return np.asarray(shot).astype(int)


def frame(page):
    return page.evaluate(f"{PLAYER}.frame()")


def test_it_plays_by_itself_and_stops(shown):
    page = shown(play(wave(300)))
    assert page.locator(".mocap-player").get_attribute("data-playing") == "true"
    before = colours(page)
    wait_until(lambda: frame(page) > 20)
    wait_until(lambda: np.any(colours(page) != before))
    page.get_by_role("button", name="pause").click()
    stopped = frame(page)
    page.wait_for_timeout(200)
    assert frame(page) == stopped


def test_where_less_motion_is_wanted_it_does_not_play_by_itself(shown):
    page = shown(play(wave(300)), reduced_motion="reduce")
    page.wait_for_timeout(200)
    assert frame(page) == 0
    page.get_by_role("button", name="play").click()
    wait_until(lambda: frame(page) > 3)


def test_scrubbing_goes_to_a_frame(resting):
    page = resting(play(wave(300)))
    before = colours(page)
    page.get_by_role("slider", name="frame").focus()
    page.keyboard.press("End")
    assert frame(page) == 299
    wait_until(lambda: "frame 299 of 300" in page.locator(".clock").inner_text())
    wait_until(lambda: np.any(colours(page) != before))


def test_the_places_drawn_are_those_of_the_motion(resting):
    motion = wave(61)
    page = resting(play(motion))
    pose = page.evaluate(f"Array.from({PLAYER}.characters[0].pose(1.5))")  # frame 45
    assert np.reshape(pose, (-1, 3)) == pytest.approx(joint_positions(motion)[45], abs=1e-4)
    between = page.evaluate(f"Array.from({PLAYER}.characters[0].pose(45.5 / 30))")
    middle = joint_positions(motion)[45:47].mean(axis=0)
    assert np.reshape(between, (-1, 3)) == pytest.approx(middle, abs=1e-4)


def test_the_view_is_not_mirrored(resting):
    page = resting(play(wave(61)))
    view = f"{PLAYER}.camera"  # set and asked in one call: between two, the page may draw
    front = f"{view}.yaw = 0; {view}.pitch = 0; {view}.place([0, 0, 0], 5, 400, 400)"
    right, up, ahead = page.evaluate(f"{front}; {view}.see(1, 0, 0)")  # a body's left is at the right
    assert (right, up, ahead) == pytest.approx((1, 0, 5))
    above = f"{view}.place([0, 1, 0], 5, 400, 300)"
    place = page.evaluate(f"{above}; {view}.ground(...{view}.pixel({view}.see(0.5, 0, -1.5)))")
    assert place == pytest.approx([0.5, -1.5])


def test_keys_play_step_turn_and_zoom(resting):
    page = resting(play(wave(300)))
    page.locator("canvas").focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowLeft")
    assert frame(page) == 1
    yaw, zoom = page.evaluate(f"{PLAYER}.camera.yaw"), page.evaluate(f"{PLAYER}.camera.zoom")
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("+")
    assert page.evaluate(f"{PLAYER}.camera.yaw") > yaw
    assert page.evaluate(f"{PLAYER}.camera.zoom") > zoom
    page.keyboard.press(" ")
    wait_until(lambda: frame(page) > 5)
    page.keyboard.press(" ")
    assert not page.evaluate(f"{PLAYER}.playing")


def test_the_mouse_turns_and_the_wheel_zooms(resting):
    page = resting(play(wave(300)))
    box = page.locator("canvas").bounding_box()
    x, y = box["x"] + 200, box["y"] + 200
    yaw, before = page.evaluate(f"{PLAYER}.camera.yaw"), colours(page)
    drag(page, (x, y), (x + 90, y + 20))
    assert page.evaluate(f"{PLAYER}.camera.yaw") == pytest.approx(yaw - 90 / 150)
    wait_until(lambda: np.any(colours(page) != before))
    page.mouse.wheel(0, -200)
    wait_until(lambda: page.evaluate(f"{PLAYER}.camera.zoom") > 1.2)
    page.get_by_role("button", name="reset view").click()
    assert page.evaluate(f"{PLAYER}.camera.zoom") == 1


@pytest.fixture
def touch(page):
    return fingers_on(page, "canvas")


def test_two_fingers_zoom(resting, touch):
    page = resting(play(wave(300)))
    yaw, before = page.evaluate(f"{PLAYER}.camera.yaw"), colours(page)
    touch([(300, 100)] * 4, [(300 + apart, 100) for apart in (50, 70, 90, 100)])
    wait_until(lambda: page.evaluate(f"{PLAYER}.camera.zoom") == pytest.approx(2, rel=0.02))
    assert page.evaluate(f"{PLAYER}.camera.yaw") == yaw
    wait_until(lambda: np.any(colours(page) != before))


def test_one_finger_across_turns_and_does_not_scroll(resting, touch):
    page = resting(play(wave(300)))
    page.evaluate("document.body.style.height = '3000px'")
    yaw, pitch, before = *page.evaluate(f"[{PLAYER}.camera.yaw, {PLAYER}.camera.pitch]"), colours(page)
    touch([(300 - 10 * k, 200 + 2 * k) for k in range(10)])
    wait_until(lambda: page.evaluate(f"{PLAYER}.camera.yaw") == pytest.approx(yaw + 90 / 150, rel=0.05))
    assert page.evaluate(f"{PLAYER}.camera.pitch") == pytest.approx(pitch + 18 / 150, rel=0.05)
    assert page.evaluate("scrollY") == 0
    wait_until(lambda: np.any(colours(page) != before))
    assert page.evaluate(f"{PLAYER}.hand.pointers.size") == 0


def test_one_finger_down_scrolls_the_page(resting, touch):
    page = resting(play(wave(300)))
    page.evaluate("document.body.style.height = '3000px'")
    view = page.evaluate(f"[{PLAYER}.camera.yaw, {PLAYER}.camera.pitch]")
    touch([(300, 300 - 15 * k) for k in range(15)])
    wait_until(lambda: page.evaluate("scrollY") > 50)
    assert page.evaluate(f"[{PLAYER}.camera.yaw, {PLAYER}.camera.pitch]") == view


def test_seams_and_stretches_off_the_path_are_marked(resting):
    off = np.where(np.arange(300) < 150, 0.0, 0.3)
    motion = wave(300)
    page = resting(play(motion, seams=[30, 90], path=[(0, 0), (0, 6)], off=off, follow=False))
    assert page.locator(".legend").inner_text() == "seamoff the path"
    left = page.locator(".scrub i").evaluate_all("marks => marks.map((mark) => parseFloat(mark.style.left))")
    assert left == pytest.approx([100 * 30 / 299, 100 * 90 / 299], abs=0.01)
    trail = page.evaluate(f"{PLAYER}.characters[0].trail.map(({{ colour, line }}) => [colour, line.length])")
    assert [colour for colour, _ in trail] == ["#E69F00", "#B00020"]
    assert [length for _, length in trail] == [151, 150]
    places = page.evaluate(f"{PLAYER}.characters[0].diamonds")
    assert places == pytest.approx(motion.root_positions[[30, 90]] * [1, 0, 1], abs=1e-3)


@pytest.mark.parametrize(("wide", "high"), [(1200, 900), (390, 844), (844, 390)])
def test_figure_path_and_controls_are_in_sight(resting, wide, high, page):
    page.set_viewport_size({"width": wide, "height": high})
    player = play(wave(600), path=[(0, 0), (3, 6), (-3, 12)], follow=False)
    resting(player)
    assert page.evaluate("document.documentElement.scrollWidth") <= wide
    for part in page.locator(".mocap-player :is(canvas, .play, .scrub input)").all():
        box = part.bounding_box()
        assert box["y"] + box["height"] <= high
    assert page.get_by_role("heading").inner_text() == "wave"
    in_canvas = page.evaluate(f"""() => {{
        const p = {PLAYER}, box = [p.canvas.clientWidth, p.canvas.clientHeight];
        p.draw();
        const points = [...p.scene.asked.map(([x, z]) => [x, 0, z]), [0, 1.7, 0], [0, 1.7, 12]];
        return points.map((q) => p.camera.pixel(p.camera.see(...q)).map((v, i) => v / box[i]));
    }}""")
    assert np.min(in_canvas) > 0
    assert np.max(in_canvas) < 1
    page.evaluate(f"{PLAYER}.camera.yaw = 2; {PLAYER}.reach = 1")
    page.get_by_role("button", name="reset view").click()
    assert page.evaluate(f"{PLAYER}.camera.yaw") == 0.7
    assert page.evaluate(f"{PLAYER}.reach") > 3


def test_a_corner_near_the_reader_is_off_the_edge(resting):
    page = resting(play(wave(60), path=[(0, 0), (0, 3), (2, 5), (2, 9), (-1, 10)], follow=False))
    heights = page.evaluate(f"""() => [false, true].flatMap((drawable) => {{
        const p = {PLAYER};
        p.scene.drawable = drawable;
        p.frameAll();
        p.draw();
        const high = p.canvas.clientHeight;
        return p.scene.asked.map(([x, z]) => p.camera.pixel(p.camera.see(x, 0, z))[1] / high);
    }})""")
    assert 0.03 < min(heights) <= max(heights) < 0.97


@on_a_phone
def test_fingers_have_room(shown):
    for part in shown(play(wave(60))).locator(".mocap-player :is(button, select, label, .scrub input)").all():
        if part.is_visible():
            box = part.bounding_box()
            assert min(box["width"], box["height"]) >= 44, part.evaluate("part => part.outerHTML")


def test_what_comes_into_sight_as_it_leaves_is_drawn(page, shown):
    page.add_init_script("""
        const Real = IntersectionObserver; window.seen = [];
        window.IntersectionObserver = class extends Real { constructor(see) { super(see); seen.push(see); } };
    """)
    shown(play(wave(60)))
    page.evaluate("seen[0]([{ isIntersecting: false }, { isIntersecting: true }])")
    assert page.evaluate(f"{PLAYER}.visible")


def test_it_fills_the_screen_when_asked(resting):
    page = resting(play(wave(60)))
    page.get_by_role("button", name="full screen").click()
    wait_until(lambda: page.evaluate("document.fullscreenElement?.className.includes('mocap-player')"))
    wait_until(lambda: page.locator("canvas").bounding_box()["height"] > 600)
    page.get_by_role("button", name="leave full screen").click()
    page.get_by_role("button", name="full screen", exact=True).wait_for()
    assert page.evaluate("document.fullscreenElement === null")


def test_names_stand_for_screen_readers_and_nothing_speaks_while_it_plays(shown):
    page = shown(play(wave(300)))
    assert page.get_by_role("application", name="A figure plays wave, 10.0 s.").is_visible()
    assert page.get_by_role("combobox", name="speed").is_visible()
    live = page.locator(".mocap-player :is(output, [aria-live], [role=status])")
    page.evaluate("window.spoken = 0")
    for part in live.all():
        watch = "new MutationObserver(() => window.spoken++)"
        part.evaluate(f"part => {watch}.observe(part, {{ childList: true, subtree: true }})")
    start = frame(page)
    wait_until(lambda: frame(page) > start + 20)
    assert page.evaluate("window.spoken") == 0


@pytest.mark.parametrize("media", [{"color_scheme": "dark"}, {"forced_colors": "active"}])
def test_the_middle_of_the_body_stands_out_on_every_ground(resting, media, page):
    resting(play(wave(60)))
    page.emulate_media(reduced_motion="reduce", **media)
    page.evaluate(f"{PLAYER}.draw()")
    ground = page.evaluate("getComputedStyle(document.querySelector('.mocap-player')).backgroundColor")
    dark = "color_scheme" in media
    assert (ground == "rgb(27, 27, 27)") == dark
    ink = page.evaluate(f"{PLAYER}.picture.ink('#333333')")
    assert (ink == "#dddddd") == dark


def test_the_camera_follows_or_stays(resting):
    page = resting(play(wave(300)))
    page.evaluate(f"{PLAYER}.seek(9)")
    assert page.evaluate(f"{PLAYER}.target()[2]") == pytest.approx(270 * 0.02, abs=0.1)
    page.get_by_label("follow").uncheck()
    assert page.evaluate(f"{PLAYER}.target()[2]") == pytest.approx(150 * 0.02, abs=0.1)


def test_ghosts_footprints_and_sources_are_seen(resting):
    page = resting(play(wave(300), sources=[(0, "first"), (150, "second")]))
    assert page.locator(".legend").inner_text() == "firstsecond"
    page.evaluate(f"{PLAYER}.seek(4)")
    assert page.evaluate(f"{PLAYER}.characters[0].colourAt(4)") == "#009E73"
    assert page.evaluate(f"{PLAYER}.characters[0].colourAt(5)") == "#56B4E9"
    page.wait_for_timeout(100)
    before = colours(page)
    page.get_by_label("ghosts").check()
    wait_until(lambda: np.any(colours(page) != before))
    prints = page.evaluate(f"{PLAYER}.characters[0].prints.length")
    assert prints == 8  # the hand is down in half of each of 7.5 periods


def test_a_print_is_strong_while_the_foot_stands(resting):
    motion = replace(wave(90), contacts={"hand": np.arange(90) < 30})
    page = resting(play(motion, follow=False))
    page.evaluate(
        f"""{PLAYER}.painted = [];
        {PLAYER}.picture.discs = (all, r, c, alpha) => all.forEach(() => {PLAYER}.painted.push(alpha)); 0"""
    )
    page.evaluate(f"{PLAYER}.seek(0.5); {PLAYER}.draw(); {PLAYER}.seek(2); {PLAYER}.draw()")
    assert page.evaluate(f"[...new Set({PLAYER}.painted)]") == [0.95, 0.25]


def test_several_characters_of_other_lengths_play_together(resting):
    page = resting(play(wave(90, name="a"), wave(300, phase=2, name="b"), follow=False))
    assert page.locator(".clock").inner_text().startswith("frame 0 of 300")
    assert page.locator(".legend").inner_text() == "ab"
    page.evaluate(f"{PLAYER}.seek(9)")
    assert page.evaluate(f"{PLAYER}.characters[0].pose(9)[2]") == pytest.approx(89 * 0.02, abs=0.05)


def test_a_single_frame_is_shown(resting):
    page = resting(play(wave(1)))
    page.get_by_role("button", name="play").click()
    page.wait_for_timeout(100)
    assert frame(page) == 0
    assert np.ptp(colours(page)) > 100


def test_every_part_that_takes_keys_keeps_them_from_jupyterlab(resting):
    page = resting(play(wave(9)))
    parts = page.locator(".mocap-player :is(canvas, button, input, select)")
    assert parts.count() >= 7
    assert {p.get_attribute("data-lm-suppress-shortcuts") for p in parts.all()} == {"true"}


@without_scripts
def test_without_scripts_the_picture_stands_there(page, tmp_path):
    (tmp_path / "player.html").write_text(play(wave(60)).page(), "utf-8")
    page.goto((tmp_path / "player.html").as_uri())
    assert page.get_by_role("img", name="A figure plays wave").is_visible()


@shaded
def test_bones_of_twelve_share_their_strokes(resting):
    """Their 360 bones in a stroke each took 60 to 110 ms a picture, shared strokes take 6 to 7."""
    page = resting(twelve())
    for pitch in (0.25, 1.5):
        counts = page.evaluate(STROKES.replace("PITCH", str(pitch)))
        assert 0 < min(counts) <= max(counts) <= 100


def test_of_a_wide_ground_fewer_lines_are_drawn_and_their_distance_is_said(resting):
    page = resting(play(wave(60), path=[(0, 0), (90, 90)], follow=False))
    said = page.evaluate(f"""() => {{
        const {{ picture }} = {PLAYER}, said = {{ lines: 0, words: [] }}, {{ stroke }} = picture;
        picture.stroke = (...what) => {{ said.lines += what[0].length; stroke.call(picture, ...what); }};
        picture.write = (text) => said.words.push(text);
        picture.drawGround([0, 0, 0], 90);
        const far = {{ ...said, words: [...said.words] }};
        said.lines = 0; said.words = [];
        picture.drawGround([0, 0, 0], 10);
        return [far, said];
    }}""")
    assert said == [{"lines": 98, "words": ["lines 5 m apart"]}, {"lines": 54, "words": []}]


def test_an_obstacle_lies_on_the_ground_where_it_is(resting):
    page = resting(play(wave(30), discs=[[0, 0.5, 0.4]]))
    x, y = page.evaluate(f"{PLAYER}.camera.pixel({PLAYER}.camera.see(0.15, 0, 0.5))")
    around = colours(page)[round(y) - 3 : round(y) + 4, round(x) - 3 : round(x) + 4]
    assert (np.abs(around - [0xBF, 0xB7, 0xA8]) < 3).all()


def test_the_top_of_a_box_is_brighter_than_its_side(resting):
    page = resting(play(wave(30), boxes=[[0.3, 0, 0.3, 0.8, 0.4, 0.8]]))

    def at(*place):
        x, y = page.evaluate(
            f"{PLAYER}.camera.pixel({PLAYER}.camera.see({place[0]}, {place[1]}, {place[2]}))"
        )
        return colours(page)[round(y), round(x)].astype(int)

    side = at(0.8, 0.2, 0.55)
    assert (np.abs(side - [0xBF, 0xB7, 0xA8]) < 3).all()
    assert (at(0.55, 0.4, 0.55) - side).min() > 15


@shaded
def test_a_box_hides_a_body_behind_it(resting):
    def coloured(*boxes):
        page = resting(play(wave(30), wave(30), boxes=boxes, yaw=0.0))
        picture = colours(page).astype(int)
        return (np.ptp(picture, axis=-1) > 60).sum()

    assert coloured([-3, 0, -0.9, 3, 3, -0.8]) > 5 * coloured([-3, 0, 0.8, 3, 3, 0.9])


def test_boxes_stay_with_bodies_that_are_beside_each_other(resting):
    page = resting(play(wave(30), wave(30), boxes=[[0, 0, 0, 1, 1, 1]]))
    assert page.evaluate(f"{PLAYER}.boxes()") == [[0, 0, 0, 1, 1, 1]]
    page.get_by_label("side by side").check()
    boxes = np.array(page.evaluate(f"{PLAYER}.boxes()"))
    away = np.array(page.evaluate(f"{PLAYER}.characters.map((character) => character.away)"))
    assert np.ptp(away, axis=0).max() > 0.3
    assert np.allclose(boxes[:, :3], away)
    assert np.allclose(boxes[:, 3:], away + 1)


def test_a_line_behind_the_camera_is_cut_where_it_passes_it(resting):
    page = resting(play(wave(60), follow=False))
    ends = page.evaluate(f"""() => {{
        const {{ picture, camera }} = {PLAYER}, places = [];
        camera.yaw = camera.pitch = 0;
        camera.place([0, 0, 0], 2, 400, 400); // at z = 2, looking along -z
        const keep = (...place) => places.push(place), a = [0, -1, 0], b = [0, -1, 4], c = [0, -1, 5];
        picture.pen = {{ beginPath() {{}}, stroke() {{}}, moveTo: keep, lineTo: keep }};
        picture.stroke([[a, b], [b, a], [c, b]], "#000", 1);
        return places;
    }}""")
    near = 200 + 600 / 0.1  # pixels below the middle: the focus is 600 pixels, the line passes 0.1 m ahead
    assert np.array(ends) == pytest.approx(np.array([[200, 500], [200, near], [200, near], [200, 500]]))


def test_capsules_lie_around_the_body_as_it_turns(page):
    """A player knows no turns: what it guesses is up to 4 cm off for a head, 6 for bent toes, 1 for limbs."""
    walk, frame = resample(generate_walk([[0, 0], [0, 5], [3, 6]]), 30), 100
    about, _ = packed_character(walk, "#000000")
    places, turns = joint_positions(walk)[frame], [walk.rotations[frame, 0]]
    for parent, turn in zip(walk.skeleton.parents[1:], walk.rotations[frame, 1:], strict=True):
        turns.append(rotations.multiply(turns[parent], turn))
    page.set_content("<!doctype html>")
    page.add_script_tag(content=joined(*SHADED, SCENE, PICTURE))
    capsules = """([about, pose]) => {
        const out = new Float32Array(SIZE * about.pieces.length);
        capsulesAt(about, pose, out, 0);
        return Array.from(out);
    }"""
    got = page.evaluate(capsules, [about, places[packed_body(walk.skeleton)[0]].ravel().tolist()])
    ends = np.reshape(got, (-1, 13))[:, [0, 1, 2, 4, 5, 6]].reshape(-1, 2, 3)
    pieces = figure(walk.skeleton)
    wanted = [
        [places[joint] + rotations.rotate(turns[joint], end) for end in (a, b)]
        for joint, a, _, b, *_ in pieces
    ]
    off = np.linalg.norm(ends - wanted, axis=2).max(axis=1)
    toes = np.array(["toes" in walk.skeleton.names[joint] for joint, *_ in pieces])
    assert off[:7].max() < 0.04
    assert off[toes].max() < 0.06
    assert off[7:][~toes[7:]].max() < 0.01


@shaded
def test_bodies_are_shaded_by_webgl_and_strokes_without_it(resting):
    drawn = f"""() => {{
        const pen = CanvasRenderingContext2D.prototype, {{ drawImage }} = pen;
        let times = 0;
        pen.drawImage = function (...what) {{ times += 1; return drawImage.apply(this, what); }};
        {PLAYER}.draw();
        pen.drawImage = drawImage;
        return times;
    }}"""
    page = resting(play(wave(30)))
    assert page.evaluate(drawn) == 1
    page.goto(f"{page.url}?flat")
    wait_until(lambda: page.evaluate(f"{PLAYER}?.pictures > 0"))
    assert page.evaluate(drawn) == 0


def test_a_part_is_marked_and_played_again_and_again(resting):
    page = resting(play(wave(300)))
    for time in (2, 4):
        page.evaluate(f"{PLAYER}.seek({time})")
        page.locator("canvas").press("l")
    assert page.locator(".message").inner_text() == "Plays this part. L plays all."
    page.evaluate(f"{PLAYER}.seek(3.9); {PLAYER}.toggle(true)")
    wait_until(lambda: page.evaluate(f"{PLAYER}.time") < 3)
    assert page.evaluate(f"{PLAYER}.time") >= 2
    page.locator("canvas").press("l")
    assert page.evaluate(f"{PLAYER}.range") == []


def test_two_walk_side_by_side_and_the_camera_holds_both(resting):
    walks = [wave(60), wave(60)]
    page = resting(play(*walks))
    before = page.evaluate(f"{PLAYER}.characters.map((one) => one.pose(1)[0])")
    page.get_by_label("side by side").check()
    after = page.evaluate(f"{PLAYER}.characters.map((one) => [one.pose(1)[0], one.pose(1)[2]])")
    assert before[0] == before[1]
    assert np.hypot(*np.subtract(*after)) == pytest.approx(1.1, abs=1e-3)
    seen = f"(character) => {PLAYER}.camera.pixel({PLAYER}.camera.see(...character.pose(0).slice(0, 3)))[0]"
    across = page.evaluate(f"({PLAYER}.draw(), {PLAYER}.characters.map({seen}))")
    assert 0 < min(across) < max(across) < page.evaluate(f"{PLAYER}.canvas.clientWidth")


def test_the_view_is_moved_by_shift_and_by_the_right_button(resting):
    page = resting(play(wave(60)))
    page.locator("canvas").press("Alt+ArrowLeft")
    moved = page.evaluate(f"{PLAYER}.panned")
    assert np.hypot(*moved) > 0.05
    page.get_by_role("button", name="reset view").click()
    assert page.evaluate(f"{PLAYER}.panned") == [0, 0]
    box = page.locator("canvas").bounding_box()
    drag(page, *((box["x"] + x, box["y"] + 200) for x in (300, 360)), button="right")
    camera, target = f"{PLAYER}.camera", page.evaluate(f"{PLAYER}.panned")
    right = page.evaluate(f"{camera}.right")
    assert np.dot(target, [right[0], right[2]]) < -0.1  # what is seen goes with the hand


# What JupyterLab gives a player, for a canvas on which a reader draws.
KERNEL = """async (player) => {
    const values = { at: [-1, 0], move: [0, 0], message: "" }, model = {
        get: (name) => values[name], set: (name, value) => { values[name] = value; }, save_changes: () => {},
        on: (event, tell) => { model[event] = tell; },
        tell: (name, value) => { values[name] = value; model[`change:${name}`](); },
    };
    Object.assign(player, { model, drawing: true });
    player.link();
    player.follow.checked = false;
    await player.load({ ...player.scene, drawable: true, autoplay: false, number: 1 });
    player.frameAll();
}"""


def test_a_stroke_is_searched_for_and_walked_near_by_with_the_line_as_inset(shown):
    page = shown(play(place(sample("walk_straight"), 2.5, [0.0, 0.0])))
    page.evaluate(f"({KERNEL})({PLAYER})")
    box = page.locator("canvas").bounding_box()
    corner = np.s_[4:140, -140:-4]
    empty = (colours(page)[corner].max(axis=-1) < 130).sum()

    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    drag(page, *((x + dx, y + dy) for dx, dy in ((0, 0), (80, 20), (120, -30), (40, -50))))
    asked = page.evaluate(f"{PLAYER}.model.get('path')")
    assert len(asked) > 10 and page.evaluate(f"{PLAYER}.looking > 0")

    mark = np.array([0xCC, 0x79, 0xA7])
    assert not (np.abs(colours(page) - mark).max(axis=-1) < 12).any()
    page.evaluate(f"{PLAYER}.model.tell('best', [[-1, 0], [1, 0], [1, 1]])")
    wait_until(lambda: (np.abs(colours(page) - mark).max(axis=-1) < 12).sum() > 100)

    scene = f"{{ ...{PLAYER}.scene, asked: {asked}, autoplay: true, number: 2 }}"
    page.evaluate(f"{PLAYER}.model.tell('scene', {scene})")
    turned = f"""(({{ camera, characters: [who], time }}) => {{
        const [a, b] = [who.pose(time - 0.5), who.pose(time + 0.2)];
        return Math.cos(camera.yaw - 0.75 - Math.atan2(b[0] - a[0], b[2] - a[2]));
    }})({PLAYER})"""
    assert page.evaluate(turned) < 0  # the camera stands behind, and comes to three quarters in front
    wait_until(lambda: page.evaluate(f"{PLAYER}.near > 0.99 && {turned} > Math.cos(0.2)"))
    assert page.evaluate(f"{PLAYER}.looking") is None
    assert page.evaluate(f"{PLAYER}.camera.pitch") == pytest.approx(0.3, abs=0.05)
    assert (colours(page)[corner].max(axis=-1) < 130).sum() > empty + 100
