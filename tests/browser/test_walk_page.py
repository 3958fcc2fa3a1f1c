"""The page that walks a line: its search is that of the plain pages, and a hand on it gets a walk."""

import base64
import re
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from PIL import Image
from scipy.spatial import cKDTree
from scipy.spatial.distance import pdist

import mocap
from mocap import body, datasets, graphs, plain
from mocap.body import rotations
from mocap.widgets.embedding import joined
from mocap.widgets.walk_bending import bend_onto
from mocap.widgets.walking_page import HERE, STEPS, pack_graph, walk_page
from tests.browser.conftest import drag, keep, shaded, watched_page
from tests.bundled import WALKS, bundled

SEARCH = """([about, packed, z, x]) => {
  const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
  const graph = prepare(unpack(about, bytes)), line = { z: Float64Array.from(z), x: Float64Array.from(x) };
  let best = null;
  for (const [, found] of new Search(graph, line).layers()) best = found;
  return best && { cost: best.cost, edges: edgesOf(best).edges.map((edge) => edge.number) };
}"""


def wanderers(seed):
    """Make a motion graph of clips whose roots go where they like, and whose bodies move a little."""
    random = np.random.default_rng(seed)
    skeleton = body.Skeleton(["root", "one", "two"], [-1, 0, 0], [[0, 0, 0], [0.2, 0.1, 0], [-0.2, 0, 0.1]])
    clips = []
    for name, frames in (("a", 150), ("b", 120), ("c", 90)):
        heading = 0.05 * random.normal(size=frames).cumsum() + random.uniform(-3, 3)
        ground = 0.035 * np.exp(1j * heading).cumsum()
        roots = np.column_stack([ground.imag, 1 + 0.02 * random.normal(size=frames), ground.real])
        turns = rotations.from_rotvec(0.02 * random.normal(size=(frames, 3, 3)).cumsum(0))
        clips.append(mocap.Motion(skeleton, roots, turns, 30, name))
    return graphs.prune(graphs.build(clips, window=10, threshold=0.12))


def as_packed_translation(offset):
    """Round a translation as the page does."""
    step = STEPS["translation"]
    return (np.rint(offset.real / step) + 1j * np.rint(offset.imag / step)) * step


def as_packed(graph):
    """Round a graph as the page does: clips and graph for the plain pages, edges in the page's order."""
    step = STEPS["root"]
    clips = [replace(clip, root_positions=np.rint(clip.root_positions / step) * step) for clip in graph.clips]
    rounded = nx.MultiDiGraph()
    rounded.add_nodes_from(graph.graph)
    order = {}
    for number, (start, end, edge) in enumerate(graph.graph.edges(data=True)):
        transform = (1, 0)
        if edge["kind"] == "transition":
            source = plain.ground(graph.clips[start[0]].root_positions[start[1]])
            target = plain.ground(graph.clips[end[0]].root_positions[end[1] - 10])
            offset = edge["transform"].rotation * target + edge["transform"].translation - source
            offset = as_packed_translation(offset)
            angle = np.rint(np.angle(edge["transform"].rotation) / STEPS["angle"]) * STEPS["angle"]
            rotation = np.exp(1j * angle)
            source, target = (clips[clip].root_positions[at] for clip, at in (start, (end[0], end[1] - 10)))
            transform = rotation, plain.ground(source) + offset - rotation * plain.ground(target)
        key = rounded.add_edge(start, end, kind=edge["kind"], frames=edge["frames"], transform=transform)
        order[start, end, key] = number
    return clips, rounded, order


@pytest.fixture(scope="module")
def scripts(browser):
    """Open an empty page that knows the search."""
    page = browser.new_page()
    page.set_content("<!doctype html>")
    files = ("bodies", "walk_search", "walk_body", "walk_bending", "walk_pieces")
    names = "prepare, unpack, Search, edgesOf, Walk, bodyAt"
    script = joined(*(HERE / f"{file}.js" for file in files))
    page.add_script_tag(content=f"{script}\nObject.assign(window, {{ {names} }});")
    yield page
    page.close()


@pytest.mark.parametrize("seed", [0, 3])
def test_it_finds_the_walk_of_the_plain_pages(scripts, seed):
    graph = wanderers(seed)
    line = plain.points_along(body.s_curve(2.0 + seed / 2).points)
    about, packed = pack_graph(graph)
    found = scripts.evaluate(
        SEARCH, [about, base64.b64encode(packed).decode(), line.real.tolist(), line.imag.tolist()]
    )
    clips, rounded, order = as_packed(graph)
    *_, (_, best) = plain.Search(clips, rounded, line).layers()
    edges, cost = [], best.cost
    while best.previous:
        edges.append(order[best.edge])
        best = best.previous
    assert found["edges"] == edges[::-1]
    assert "transition" in {rounded.edges[edge]["kind"] for edge in order if order[edge] in edges}
    assert found["cost"] == pytest.approx(cost, abs=1e-6)


BENT = """([about, packed, z, x]) => {
  const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
  const walk = new Walk(prepare(unpack(about, bytes)));
  walk.follow({ z: Float64Array.from(z), x: Float64Array.from(x) });
  while (!walk.done) for (const _ of walk.grow());
  const bodies = Array.from({ length: walk.frames }, (_, frame) => bodyAt(walk, frame).positions);
  return { edges: walk.edges.map((edge) => edge.number), bodies };
}"""


@pytest.mark.parametrize("line", [body.circle(1.5), body.s_curve(9.0)], ids=["circle", "S"])
def test_a_walk_is_bent_as_its_twin_in_python_bends_it(scripts, line):
    graph = bundled("walk_circle", "walk_curve_1")
    about, packed = pack_graph(graph)
    points = plain.points_along(line.points)
    packed = base64.b64encode(packed).decode()
    grown = scripts.evaluate(BENT, [about, packed, points.real.tolist(), points.imag.tolist()])
    all_edges = list(graph.graph.edges(keys=True))
    edges = [all_edges[number] for number in grown["edges"]]
    bent = bend_onto(graph, edges, body.GroundPath(np.column_stack([points.imag, points.real])))
    assert len(edges) > 10
    apart = np.linalg.norm(body.joint_positions(bent) - grown["bodies"], axis=-1)
    apart = apart[:, np.isfinite(apart).all(axis=0)]
    assert np.percentile(apart, 99) < 0.006  # metres: the page has rounded numbers
    assert apart.max() < 0.02


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """Write the page of the bundled clips that only walk."""
    path = tmp_path_factory.mktemp("walk") / "walk.html"
    path.write_text(walk_page(bundled(*WALKS)), "utf-8")
    assert path.stat().st_size < 600_000
    return path


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Write the page of all bundled clips, with a joint and a clip whose names are no names in HTML."""
    graph = bundled(*datasets.SAMPLES)
    skeleton = graph.clips[0].skeleton
    names = ["<!--<script>" if name == "head" else name for name in skeleton.names]
    skeleton = replace(skeleton, names=names)
    clips = tuple(replace(clip, skeleton=skeleton, name=f"<!--<script>{clip.name}") for clip in graph.clips)
    path = tmp_path_factory.mktemp("whole") / "walk.html"
    path.write_text(walk_page(replace(graph, clips=clips)), "utf-8")
    assert path.stat().st_size < 1_200_000
    return path


PRESSED = """async ([kind, line]) => {
  const drawn = line.map(([z, x]) => [z, x]);
  page.set(drawn, { anew: true });
  page.finish();
  [...document.querySelectorAll("#kinds button")].find((button) => button.textContent === kind).click();
  page.play(false);
  let empty = 0;
  while (!page.walk.frames) {
    await new Promise((resolve) => setTimeout(resolve, 5));
    page.grow(20);
    empty += page.bodies().length ? 0 : 1;
  }
  page.finish();
  const { walk } = page;
  const { clips } = page.graph;
  const owner = (edge, i) => (edge.seam && page.graph.weights[i] < 0.5
    ? [edge.end.clip, edge.end.frame - edge.frames + i] : [edge.start.clip, edge.start.frame + i]);
  const frames = walk.edges.flatMap((edge) => Array.from({ length: edge.frames }, (_, i) => owner(edge, i)));
  const feet = page.about.limbs.flatMap(({ joints }) => joints.slice(2));
  const stands = frames.map(([clip, frame]) => feet.map((_, n) => (clips[clip].stands[frame] >> n) & 1));
  const bodies = frames.map((_, frame) => {
    page.time = frame;
    const { positions } = page.bodies()[0];
    return [positions[0], ...feet.map((joint) => positions[joint])];
  });
  return { empty, frames, stands, bodies, points: drawn };
}"""
KINDS = ("walk", "jog", "sneak")
LINES = {
    "straight": [[0.01 * i, 0] for i in range(900)],
    "S": [[0.01 * i, 0.8 * np.sin(0.008 * i)] for i in range(800)],
    "wide": [[3 * np.sin(i / 300), 3 - 3 * np.cos(i / 300)] for i in range(900)],
    "right": [[2 * np.sin(i / 200), 2 * np.cos(i / 200) - 2] for i in range(1000)],
    "tight": [[np.sin(i / 100), 1 - np.cos(i / 100)] for i in range(560)],
    "corner": [[0.01 * min(i, 400), 0.01 * max(i - 400, 0)] for i in range(800)],
}


@pytest.mark.parametrize("kind", KINDS)
def test_each_button_walks_as_it_says_on_six_lines(page, whole, kind):
    page.goto(f"file://{whole}?flat")
    page.wait_for_function("window.page?.walk.frames")
    assert page.evaluate("[...document.querySelectorAll('#kinds button')].map((b) => b.textContent)") == [
        *KINDS
    ]
    clips = bundled(*datasets.SAMPLES).clips
    for name, line in LINES.items():
        seen = page.evaluate(PRESSED, [kind, np.array(line).tolist()])
        assert seen["empty"] == 0, name
        own = [
            clips[clip].labels[kind][frame] if kind in clips[clip].labels else False
            for clip, frame in seen["frames"]
        ]
        assert np.mean(own) >= 0.95, name
        bodies = np.array(seen["bodies"])[:, :, [2, 0]]
        distance, _ = cKDTree(line).query(bodies[:, 0])
        assert distance.mean() <= 0.1, name
        missed, _ = cKDTree(bodies[:, 0]).query(line)
        assert missed.mean() <= 0.1, name
        for foot, stands in enumerate(np.array(seen["stands"], bool).T, 1):
            for frames in np.split(np.arange(len(stands)), np.flatnonzero(np.diff(stands)) + 1):
                places = bodies[frames, foot]
                assert not stands[frames[0]] or pdist(places).max(initial=0) <= 0.02, (name, foot, frames[0])


def test_an_impossible_kind_keeps_the_walk_and_says_why(page, whole):
    page.goto(f"file://{whole}?flat")
    page.wait_for_function("window.page?.walk.frames")
    page.evaluate("page.finish()")
    walk = page.evaluate("[page.walk.frames, page.walk.labels]")
    page.evaluate(
        "page.graph.nodes.forEach((node) => { node.out = node.out.filter((edge) => !(edge.labels & 1)); })"
    )
    page.get_by_role("button", name=page.evaluate("page.about.labels[0]"), exact=True).click()
    page.wait_for_function("page.walk.frames > 0 && !page.growing")
    assert page.evaluate("[page.walk.frames, page.walk.labels]") == walk
    assert (
        page.locator("#message").text_content()
        == "These clips have no jog along this line. The walk before stays."
    )
    assert page.locator("#kinds [aria-pressed=true]").text_content() == "walk"


@shaded
def test_a_round_stroke_is_a_circle_on_the_ground_seen_from_above(page, file):
    page.goto(f"file://{file}")
    page.wait_for_function("window.page?.walk.frames")
    before = page.evaluate("({ ...page.camera.goal })")
    places = [(600 + 150 * np.cos(a), 420 + 150 * np.sin(a)) for a in np.linspace(0, 6.2, 60)]
    page.mouse.move(*places[0])
    assert page.evaluate("page.camera.goal.pitch") == before["pitch"]
    page.mouse.down()
    looks = []
    for place in places[1:]:
        page.mouse.move(*place)
        looks.append(page.evaluate("[page.camera.at.pitch, page.camera.at.far, page.bodies().length]"))
    pitch, far, bodies = np.array(looks).T
    assert np.degrees(pitch).min() >= 80
    assert np.ptp(far) == 0
    assert bodies.min() == 1  # the figure stays
    across = page.evaluate("[[0, 400], [1200, 400]].map(([x, y]) => page.camera.ground(x, y))")
    assert np.hypot(*np.subtract(*across)) == pytest.approx(10, abs=0.01)
    stroke = np.array(page.evaluate("page.stroke"))
    radius = np.hypot(*(stroke - (stroke.max(axis=0) + stroke.min(axis=0)) / 2).T)
    assert np.ptp(radius) / radius.mean() < 0.03
    page.mouse.up()
    page.wait_for_function("page.walk.done && page.camera.at.pitch < 0.6")
    assert "off the line" in page.locator("#message").text_content()


def test_a_corner_is_rounded_beside_the_line_that_was_drawn(page, file):
    page.goto(f"file://{file}?flat")
    page.wait_for_function("window.page?.walk.frames")
    drag(page, (300, 300), (800, 300), (800, 600), (300, 600), steps=30)
    page.evaluate("page.finish()")
    told = page.locator("#message").text_content()
    rounded = re.search(r"rounded by (0\.\d) m", told)
    assert rounded, told
    apart, _ = cKDTree(page.evaluate("page.points")).query(page.evaluate("page.drawn"))
    assert float(rounded[1]) == pytest.approx(apart.max(), abs=0.06)
    off = int(re.search(r"(\d+) cm off", told)[1]) / 100
    walked = page.evaluate("Array.from({ length: page.walk.frames }, (_, f) => page.positionAt(f))")
    missed, _ = cKDTree(walked).query(page.evaluate("page.drawn"))
    assert off == pytest.approx(missed.mean(), abs=0.02)


def test_where_motion_is_reduced_it_walks_after_a_stroke(browser, file):
    with watched_page(browser, reduced_motion="reduce") as (page, faults):
        page.goto(f"file://{file}?flat")
        page.wait_for_function("window.page?.walk.frames")
        assert not page.evaluate("page.playing")
        drag(page, (300, 300), (800, 400))
        page.wait_for_function("page.walk.frames && page.time > 2")
    assert faults == []


def test_a_link_opens_the_line_and_says_that_it_is_a_gift(page, file):
    page.goto(f"file://{file}?flat")
    page.wait_for_function("window.page?.walk.frames")
    drag(page, (300, 300), (800, 400), (900, 600), steps=20)
    drawn = page.evaluate("page.drawn.length")
    page.click("#copy")
    page.wait_for_function("document.querySelector('#message').textContent.includes('link')")
    address = page.evaluate("location.href")
    page.goto("about:blank")
    page.goto(address)
    page.wait_for_function("window.page?.walk.frames")
    assert page.get_by_text("Somebody drew this for you").is_visible()
    assert page.evaluate("page.drawn.length") == pytest.approx(drawn, rel=0.1)


def luminance(colour):
    values = np.array([int(colour[at : at + 2], 16) for at in (1, 3, 5)]) / 255
    linear = np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
    return linear @ [0.2126, 0.7152, 0.0722]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_words_and_seams_are_seen_on_the_ground(scheme):
    html = (HERE / "walk.html").read_text("utf-8")
    roots = re.findall(r":root \{ ([^}]*) \}", html)
    colours = dict(re.findall(r"--(\w+): (#\w{6})", roots[scheme == "dark"]))
    scene = (HERE / "walk_scene.js").read_text("utf-8")
    seams = re.findall(r"#\w{6}", re.search(r"COLOURS = \[(.*)\]", scene)[1])

    def contrast(colour):
        low, high = sorted([luminance(colour), luminance(colours["ground"])])
        return (high + 0.05) / (low + 0.05)

    assert min(contrast(colours[word]) for word in ("ink", "soft", "line")) >= 4.5
    assert min(map(contrast, seams)) >= 3


def walks(page):
    page.wait_for_function("window.page?.walk.done")
    return page.evaluate("({ frames: page.walk.frames, metres: page.line.z.length / 100 })")


@shaded
def test_a_hand_draws_and_it_walks(page, file, tmp_path):
    page.goto(f"file://{file}")
    page.wait_for_function("window.page?.walk.frames")
    page.evaluate("page.play(false); page.time = 0; page.view(true); page.aim(0, true)")
    # Figure and camera stand still, however slow the machine is.
    before = page.evaluate("page.line.z.length")
    drag(page, (300, 700), (500, 560), (700, 640), (900, 520), (980, 600))
    page.wait_for_function("page.growing === null && page.walk.frames > 0")
    assert page.evaluate("page.line.z.length") != before
    page.evaluate("page.finish()")
    walked = walks(page)
    assert 0.8 < walked["frames"] / 30 / walked["metres"] < 1.6  # seconds for a metre
    told = page.locator("#message").text_content()
    assert int(re.search(r"(\d+) cm off", told)[1]) <= 10, told  # its corners are rounded
    assert "metres along a line" in page.locator("#stage").get_attribute("aria-label")

    address = page.evaluate("location.href")  # whoever opens it sees the same line
    line = page.evaluate("[...page.line.z]")
    page.goto("about:blank")
    page.goto(address)
    page.wait_for_function("window.page?.walk.frames")
    assert len(page.evaluate("[...page.line.z]")) == pytest.approx(len(line), rel=0.1)


BACK = """([on, round]) => {
  const far = ([z, x], [a, b]) => Math.hypot(a - z, b - x);
  const count = (length, of) => Array.from({ length }, (_, i) => of(i));
  const way = ([z, x], a) => count(500, (i) => [z + 0.01 * i * Math.cos(a), x + 0.01 * i * Math.sin(a)]);
  const walk = (line) => { page.set(line); page.finish(); };
  page.play(false);
  page.walk = null;
  walk(way([0, 0], 0.3));
  const bodies = () => [on - 1, on, on + 1].flatMap((time) => {
    page.time = time;
    return page.bodies()[0].positions;
  });
  const shown = bodies();
  page.time = on;
  const before = page.position(), back = way(before, 0.3 + round);
  walk(back);
  const moved = bodies().map((joint, k) => Math.hypot(...joint.map((value, c) => value - shown[k][c])));
  page.time = on;
  const places = count(page.walk.frames - on, (i) => page.positionAt(on + i));
  const steps = places.slice(1).map((place, i) => far(place, places[i]));
  const offs = places.slice(-15).map((place) => Math.min(...back.map((point) => far(place, point))));
  return [far(places[0], before), Math.max(...moved), Math.max(...steps), Math.max(...offs)];
}"""


@pytest.mark.parametrize("round_", [1.5, 3.1])
def test_a_line_that_leads_back_is_walked_from_where_the_figure_is(page, file, round_):
    page.goto(f"file://{file}")
    page.wait_for_function("window.page?.walk.frames")
    for on in (40, 55, 70):
        jump, moved, step, off = page.evaluate(BACK, [on, round_])  # metres
        assert jump == 0
        assert moved < 1e-3  # the body that is shown stays as it was
        assert step < 0.1  # in a frame
        assert off < 0.2  # the walk's last half second, from the reader's line


@shaded
def test_it_is_saved_as_motion_and_as_pictures(page, file, tmp_path):
    page.goto(f"file://{file}")
    page.wait_for_function("window.page?.walk.frames")
    page.focus("#stage")
    for key in [*["ArrowUp"] * 6, "Enter"]:  # a short walk: its pictures take long
        page.keyboard.press(key)
    page.evaluate("page.finish()")
    with page.expect_download() as given:
        page.click("#save summary")
        page.click("#bvh")
    given.value.save_as(tmp_path / "walk.bvh")
    motion = mocap.load(tmp_path / "walk.bvh")
    places = np.array([page.evaluate(f"page.positionAt({frame})") for frame in (0, 20, 40)])
    assert motion.root_positions[[0, 20, 40]][:, [2, 0]] == pytest.approx(places, abs=1e-3)
    assert len(motion) == page.evaluate("page.walk.frames")
    with page.expect_download() as given:
        page.click("#save summary")
        page.click("#gif")
    given.value.save_as(tmp_path / "walk.gif")
    film = Image.open(tmp_path / "walk.gif")
    film.seek(film.n_frames - 1)  # all pictures can be read
    assert film.n_frames > 30
    assert len(film.convert("RGB").getcolors(10**6)) > 20


@shaded
def test_a_film_is_recorded_while_the_walk_plays(page, file, tmp_path):
    page.goto(f"file://{file}")
    page.wait_for_function("window.page?.walk.frames")
    page.evaluate("page.set(Array.from({ length: 150 }, (_, i) => [0.01 * i, 0]), { anew: true })")
    page.evaluate("page.finish()")
    page.click("#save summary")
    with page.expect_download() as given:
        page.click("#film")
        page.wait_for_function("document.querySelector('#message').textContent.startsWith('recording')")
        assert not page.evaluate("page.saving")  # it walks on
        assert page.locator("#film").text_content() == "stop the film"
    given.value.save_as(tmp_path / "film")
    assert given.value.suggested_filename in ("walk.mp4", "walk.webm")
    content = (tmp_path / "film").read_bytes()
    assert content[4:8] == b"ftyp" or content[:4] == b"\x1aE\xdf\xa3"  # MP4, or WebM
    assert len(content) > 5000
    assert page.locator("#message").text_content() == f"saved {given.value.suggested_filename}"
    assert page.locator("#film").text_content() == "film"


def test_a_browser_that_records_no_films_says_so(page, file):
    page.goto(f"file://{file}?flat")
    page.wait_for_function("window.page?.walk.frames")
    page.evaluate("window.MediaRecorder = undefined")
    page.click("#save summary")
    page.click("#film")
    assert page.locator("#message").text_content() == "This browser records no films: save a GIF."
    assert page.evaluate("page.film") is None


def test_a_stroke_is_undone(page, file):
    page.goto(f"file://{file}?flat")
    page.wait_for_function("window.page?.walk.frames")
    lines = [page.evaluate("page.drawn")]
    assert not page.locator("#undo").is_visible()
    for end in ((800, 500), (800, 300)):
        drag(page, (300, 400), (500, 380), end)
        page.evaluate("page.finish()")
        lines.append(page.evaluate("page.drawn"))
    page.click("#undo")
    assert page.evaluate("page.drawn") == lines[1]
    page.focus("#stage")
    page.keyboard.press("Control+z")
    assert page.evaluate("page.drawn") == lines[0]
    assert not page.locator("#undo").is_visible()
    page.keyboard.press("Control+z")  # nothing is left to undo
    assert page.evaluate("page.drawn") == lines[0]


@shaded
def test_keys_draw_and_a_tap_on_a_seam_shows_both_moments(page, file):
    page.goto(f"file://{file}")
    page.wait_for_function("window.page?.walk.frames")
    page.evaluate(
        "() => { const set = page.set; page.set = (line) => set.call(page, (window.drawn = line)); }"
    )
    page.focus("#stage")
    for key in [*["ArrowUp"] * 6, "ArrowLeft", "ArrowLeft", *["ArrowUp"] * 6, "Enter"]:
        page.keyboard.press(key)
    page.evaluate("page.finish()")
    assert page.evaluate("drawn.length") == pytest.approx(420, abs=80)
    page.evaluate("page.tap(page.positionAt(page.seams()[0].frame))")
    assert "Two similar moments" in page.locator("#moments").text_content()
    assert page.evaluate("page.bodies().length") == 2
    page.evaluate("page.tap([99, 99])")
    assert not page.locator("#moments").is_visible()


@pytest.mark.parametrize(("width", "scheme"), [(390, "dark"), (848, "light")])
def test_it_fits_and_needs_no_graphics_card(browser, file, width, scheme):
    with watched_page(
        browser, viewport={"width": width, "height": 760}, color_scheme=scheme, reduced_motion="reduce"
    ) as (page, faults):
        page.goto(f"file://{file}?flat")
        page.wait_for_function("window.page?.walk.frames")
        seen = page.evaluate("[page.playing, page.scene.gl, document.documentElement.scrollWidth]")
        assert seen == [False, None, width]
        keep(page, f"walk-{width}-{scheme}")
    assert faults == []
