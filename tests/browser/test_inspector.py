"""The inspector in a browser: what it computes is what the package computes, and a hand can use it."""

import io

import numpy as np
import pytest
from PIL import Image

from mocap.blending.joining import align_window, blend, splice
from mocap.blending.weights import cubic_weights, linear_weights
from mocap.body import GroundPath, joint_positions, resample
from mocap.course.lab.showing import inspector
from mocap.datasets.samples import sample
from mocap.graphs.compiled_graph import compile_graph
from mocap.matching import align, distance_grid, point_cloud
from mocap.quality.seam_measures import jumps
from mocap.steering.path_following import follow_path
from mocap.synthesis.walk_to_motion import to_motion
from tests.browser.conftest import fingers_on, on_a_phone, wait_until
from tests.bundled import bundled

IT = "document.querySelector('.mocap-inspector').inspector"
WALKS = [resample(sample(f"walk_curve_{n}"), 30)[:200] for n in (1, 2)]
STANDARD = 60  # milliseconds from point to picture


def choose(page, i, j):
    page.evaluate(f"{IT}.choose({IT}.maps.grid.cell({i}, {j}))")


def pixels(page, canvas):
    shot = Image.open(io.BytesIO(page.locator(f".mocap-inspector {canvas}").screenshot())).convert("RGB")
    return np.asarray(shot).astype(int)


def test_turn_and_distance_are_those_of_the_package(resting):
    page = resting(inspector(*WALKS))
    grid = np.sqrt(distance_grid(*WALKS, window=10))
    for i, j in np.random.default_rng(1).integers(0, 190, (12, 2)).tolist():
        choose(page, i, j)
        a, b = (point_cloud(w[k : k + 10]).reshape(-1, 3) for w, k in zip(WALKS, (i, j), strict=True))
        exact = align(a, b)
        found = page.evaluate(f"(() => {{ const t = {IT}.transform; return [t.angle, t.x, t.z]; }})()")
        assert np.abs(np.exp(1j * found[0]) - np.exp(1j * exact.angle)) < 1e-3
        moved = exact._replace(angle=found[0], x=found[1], z=found[2]).apply_points(b)
        assert np.abs(moved - exact.apply_points(b)).max() < 2e-3
        page.evaluate(f"{IT}.draw()")
        assert f"RMS distance {100 * grid[i, j]:.1f} cm" in page.locator(".status").inner_text()


@pytest.mark.parametrize("weights", [cubic_weights, linear_weights])
def test_the_seam_and_its_jolts_are_those_of_the_package(resting, weights):
    page = resting(inspector(*WALKS, at=(56, 20)))
    page.locator("[data-tab=seam]").click()
    page.locator(".kinds").select_option(weights.__name__.removesuffix("_weights"))
    found = np.array(page.evaluate(f"{IT}.seam.map((frame) => frame.positions)"))
    laid = align_window(WALKS[0], 56, WALKS[1], 20, 10)
    joined = splice(WALKS[0], 56, blend(WALKS[0][56:66], laid[20:30], weights(10)), laid, 30)
    before, after = page.evaluate(f"[{IT}.before, {IT}.after]")
    part = joined[56 - before : 66 + after]
    assert np.abs(found - joint_positions(part)).max() < 5e-4
    jolts = page.evaluate(f"{IT}.jolts")
    assert jolts[0] is None and jolts[-1] is None
    assert np.abs(np.array(jolts[1:-1], float) - jumps(part)[1:-1]).max() < 5e-3


def test_around_a_transition_the_page_measures_the_grid_itself(resting):
    graph = bundled("walk_circle", "walk_curve_1")
    page = resting(inspector(graph))
    wait_until(lambda: page.evaluate(f"Boolean({IT}.maps.grid.grid)"))
    first, i, second, j = page.evaluate(
        f"(() => {{ const p = {IT}.pick; return [p.first, p.i, p.second, p.j]; }})()"
    )
    found = np.array(page.evaluate(f"Array.from({IT}.maps.grid.grid.values)"), float).reshape(41, 41)
    whole = np.sqrt(distance_grid(graph.clips[first], graph.clips[second], window=graph.window))
    padded = np.pad(whole, 20, constant_values=np.nan)[i : i + 41, j : j + 41]
    shades = (padded - np.nanmin(padded)) / np.ptp(padded[np.isfinite(padded)])
    assert np.array_equal(np.isnan(found), np.isnan(shades))
    assert np.nanmax(np.abs(found - shades)) < 1e-3


@pytest.mark.benchmark
def test_from_point_to_picture_takes_less_than_sixty_milliseconds(resting):
    page = resting(inspector(*WALKS))
    for tab in ("windows", "turn", "weights", "seam"):
        page.locator(f"[data-tab={tab}]").click()
        took = []
        for k in range(15):
            page.locator(".grid").click(position={"x": 80 + 9 * k, "y": 60 + 7 * k})
            wait_until(lambda: page.evaluate(f"{IT}.asked === null"))
            took.append(page.evaluate(f"{IT}.took"))
        assert np.median(took) < STANDARD, (tab, took)


def test_a_click_and_the_keys_choose_windows_and_minima(resting):
    page = resting(inspector(*WALKS, at=(56, 20)))
    grid = page.locator(".grid")
    grid.focus()
    for key, place in (("ArrowDown", [57, 20]), ("ArrowRight", [57, 21]), ("Shift+ArrowUp", [47, 21])):
        page.keyboard.press(key)
        assert page.evaluate(f"[{IT}.pick.i, {IT}.pick.j]") == place
    page.keyboard.press("n")
    minima = page.evaluate(f"{IT}.maps.grid.minima")
    assert page.evaluate(f"[{IT}.pick.i, {IT}.pick.j]") == minima[0]
    left, top, scale = page.evaluate(
        f"(() => {{ const b = {IT}.maps.grid.box; return [b.left, b.top, b.scale]; }})()"
    )
    grid.click(position={"x": left + 30.5 * scale, "y": top + 120.5 * scale})
    assert page.evaluate(f"[{IT}.pick.i, {IT}.pick.j]") == [120, 30]
    wait_until(lambda: "Frames 120 to 129" in page.locator(".status").inner_text())


def test_keys_move_the_view_of_the_bodies(resting):
    page = resting(inspector(*WALKS, at=(56, 20)))
    page.locator(".bodies").focus()
    before = pixels(page, ".bodies")
    page.keyboard.press("Alt+ArrowRight")
    page.keyboard.press("l")  # marks a part of a player, which the inspector has not: nothing happens
    wait_until(lambda: np.any(pixels(page, ".bodies") != before))
    assert page.evaluate(f"{IT}.panned") != [0, 0]


def test_the_turn_is_dragged_and_comes_back(resting):
    page = resting(inspector(*WALKS, at=(47, 15)))
    page.locator("[data-tab=turn]").click()
    before = pixels(page, ".bodies")
    page.locator(".scrub").focus()
    page.keyboard.press("Home")
    wait_until(lambda: "θ = −180°" in page.locator(".now").inner_text())
    assert np.any(pixels(page, ".bodies") != before)
    page.locator(".chart").click(position={"x": 46, "y": 50})  # the left end of its axis
    wait_until(lambda: "θ = −180°" in page.locator(".now").inner_text())
    page.locator(".chart").click(position={"x": 120, "y": 50})
    wait_until(lambda: "θ = −180°" not in page.locator(".now").inner_text())
    page.get_by_role("button", name="best turn").click()
    wait_until(lambda: page.locator(".now").inner_text().startswith("θ = 87°: 2.1 cm"))


def test_the_seam_plays_on_one_clock(resting):
    page = resting(inspector(*WALKS, at=(56, 20)))
    page.locator("[data-tab=seam]").click()
    still = [pixels(page, canvas) for canvas in (".bodies", ".chart", ".grid")]
    page.get_by_role("button", name="play").click()
    wait_until(lambda: page.evaluate(f"{IT}.frame() > 4"))
    page.get_by_role("button", name="pause").click()
    moved = [pixels(page, canvas) for canvas in (".bodies", ".chart", ".grid")]
    assert all(np.any(a != b) for a, b in zip(still, moved, strict=True))
    page.locator(".bodies").focus()
    frame = page.evaluate(f"{IT}.frame()")
    page.keyboard.press("ArrowRight")
    assert page.evaluate(f"{IT}.frame()") == frame + 1


def test_seams_are_chosen_on_a_walk_and_lit_where_they_stand(resting):
    graph = bundled("walk_circle", "walk_curve_1")
    followed = follow_path(compile_graph(graph), GroundPath([[0, 0], [0, 3], [2, 5], [6, 5]]))
    page = resting(inspector(followed))
    page.locator(".walk").focus()
    first = page.evaluate(f"{IT}.pick.seam")
    page.keyboard.press("ArrowLeft" if first else "ArrowRight")
    assert page.evaluate(f"{IT}.pick.seam") == (first - 1 if first else 1)
    page.locator("[data-tab=seam]").click()
    found, frame, before = page.evaluate(
        f"[{IT}.seam.map((f) => f.positions[0][1]), {IT}.pick.frame, {IT}.before]"
    )
    walked = to_motion(graph, followed.walk)[frame - before :][: len(found)]
    assert np.abs(np.array(found) - walked.root_positions[:, 1]).max() < 5e-4
    page.locator(".graph").focus()
    for key in ("ArrowRight", "ArrowLeft", "ArrowUp"):
        page.keyboard.press(key)
    point = f"{IT}.walk?.path?.[0] ?? {IT}.scene.walk.path[{IT}.scene.walk.seams[0].frame]"
    x, z = page.evaluate(f"{IT}.maps.walk.positionOf({point})")
    page.locator(".walk").click(position={"x": x, "y": z})
    assert page.evaluate(f"{IT}.pick.seam") == 0


def test_one_tab_is_no_choice_and_a_flat_grid_leaves_no_gap(resting):
    page = resting(inspector(WALKS[0][:40], WALKS[1], show=["windows"]))
    page.set_viewport_size({"width": 390, "height": 844})
    assert page.locator(".tabs").is_hidden()
    wait_until(lambda: page.locator(".grid").bounding_box()["height"] < 120)
    assert page.evaluate(f"{IT}.maps.grid.box.scale") == pytest.approx(
        page.evaluate(f"({IT}.maps.grid.canvas.clientWidth - 50) / {IT}.maps.grid.grid.columns")
    )


@pytest.mark.parametrize("part", [".chart", ".grid"])
def test_a_finger_across_chooses_and_a_finger_up_scrolls(resting, part):
    page = resting(inspector(*WALKS, at=(56, 20)))
    page.set_viewport_size({"width": 390, "height": 844})
    page.evaluate("document.body.style.height = '3000px'")
    page.locator("[data-tab=turn]").click()
    chosen = f"[{IT}.pick.i, {IT}.pick.j, {IT}.angle]"
    before, fingers = page.evaluate(chosen), fingers_on(page, part)
    fingers([(120 + 9 * step, 60 + step) for step in range(12)])
    wait_until(lambda: page.evaluate(chosen) != before)
    assert page.evaluate("scrollY") == 0
    before = page.evaluate(chosen)
    fingers([(120, 110 - 9 * step) for step in range(12)])
    wait_until(lambda: page.evaluate("scrollY") > 50)
    assert page.evaluate(chosen) == before


@on_a_phone
def test_it_fits_a_phone_is_dark_and_obeys_a_finger(resting):
    page = resting(inspector(*WALKS, at=(56, 20)), color_scheme="dark")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    page.locator(".grid").tap(position={"x": 150, "y": 150})
    assert page.evaluate(f"[{IT}.pick.i, {IT}.pick.j]") != [56, 20]
    page.locator("[data-tab=turn]").tap()
    assert page.locator("[data-tab=turn]").get_attribute("aria-pressed") == "true"
    assert page.locator(".mocap-inspector").evaluate("(root) => root.classList.contains('dark')")
