"""The page that walks a line: its search is that of the plain pages, and a hand on it gets a walk."""

import base64
import re
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from PIL import Image

import mocap
from mocap import body, graphs, plain
from mocap.body import rotations
from mocap.widgets.embedding import joined
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
    script = joined(HERE / "walk_search.js")
    page.add_script_tag(content=script + "\nObject.assign(window, { prepare, unpack, Search, edgesOf });")
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


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """Write the page of the bundled clips that only walk."""
    path = tmp_path_factory.mktemp("walk") / "walk.html"
    path.write_text(walk_page(bundled(*WALKS)), "utf-8")
    assert path.stat().st_size < 600_000
    return path


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
    assert int(re.search(r"(\d+) cm off", told)[1]) <= 6, told
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
  page.time = on;
  const before = page.position(), back = way(before, 0.3 + round);
  walk(back);
  const places = count(page.walk.frames - on, (i) => page.positionAt(on + i));
  const steps = places.slice(1).map((place, i) => far(place, places[i]));
  const offs = places.slice(-15).map((place) => Math.min(...back.map((point) => far(place, point))));
  return [far(places[0], before), Math.max(...steps), Math.max(...offs)];
}"""


@pytest.mark.parametrize("round_", [1.5, 3.1])
def test_a_line_that_leads_back_is_walked_from_where_the_figure_is(page, file, round_):
    page.goto(f"file://{file}")
    page.wait_for_function("window.page?.walk.frames")
    for on in (40, 55, 70):
        jump, step, off = page.evaluate(BACK, [on, round_])  # metres
        assert jump == 0
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
        page.click("#bvh")
    given.value.save_as(tmp_path / "walk.bvh")
    motion = mocap.load(tmp_path / "walk.bvh")
    places = np.array([page.evaluate(f"page.positionAt({frame})") for frame in (0, 20, 40)])
    assert motion.root_positions[[0, 20, 40]][:, [2, 0]] == pytest.approx(places, abs=1e-3)
    assert len(motion) == page.evaluate("page.walk.frames")
    with page.expect_download() as given:
        page.click("#gif")
    given.value.save_as(tmp_path / "walk.gif")
    film = Image.open(tmp_path / "walk.gif")
    film.seek(film.n_frames - 1)  # all pictures can be read
    assert film.n_frames > 30
    assert len(film.convert("RGB").getcolors(10**6)) > 20


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
