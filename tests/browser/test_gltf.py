"""A `.glb` in three.js, as a viewer shows it: all joints are where ours are, and a body is drawn."""

import io
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mocap.body import joint_positions, resample
from mocap.datasets import samples
from mocap.errors import MocapWarning
from mocap.files.load_save import save, save_clips
from tests.browser.conftest import shaded, wait_until
from tests.editing.bodies import LONG, along_x, renamed, rested

ADDRESS = "http://127.0.0.1:9"  # nobody listens there: the test itself answers
PAGE = Path(__file__).with_name("gltf_page.html")


@pytest.fixture(scope="module")
def three():
    """Return the folder of the npm package three, where Node finds one."""
    if shutil.which("node"):
        asked = "console.log(require.resolve('three/addons/loaders/GLTFLoader.js'))"
        done = subprocess.run(["node", "-e", asked], capture_output=True, text=True, check=False)
        if done.returncode == 0:
            return Path(done.stdout.strip()).parents[3]
    pytest.skip("no three.js here: npm install --no-save three")


@pytest.fixture
def show(page, three) -> Callable[[Path], None]:
    """Return a function that opens a page with a .glb."""

    def open_page(file):
        def answer(route):
            name = route.request.url.removeprefix(ADDRESS + "/")
            here = {"": PAGE, "walk.glb": file}
            route.fulfill(path=here.get(name) or three.parent / name)

        page.route(f"{ADDRESS}/**", answer)
        page.goto(f"{ADDRESS}/")
        wait_until(lambda: page.evaluate("window.ready"))

    return open_page


@shaded
def test_three_js_plays_each_clip_on_one_skeleton_that_is_bound_at_rest(page, show, tmp_path):
    clips = [resample(samples.sample(name)[:360], 30) for name in ("walk_straight", "jog")]
    clips = [rested(renamed(clip, LONG), along_x(clip.skeleton)) for clip in clips]
    with pytest.warns(MocapWarning, match="does not stand"):
        save_clips(clips, tmp_path / "clips.glb", root=True)
    show(tmp_path / "clips.glb")
    for number in (0, 1, 0):
        assert page.evaluate("window.play", number) == clips[number].name
        exact = joint_positions(clips[number])
        for frame in range(0, len(exact), 17):
            rows = page.evaluate("window.places", frame / clips[number].fps)
            *joints, floor = (row[1:] for row in rows)
            assert np.abs(np.array(joints) - exact[frame]).max() < 1e-4
            np.testing.assert_allclose(floor, exact[frame, 0] * [1, 0, 1], atol=1e-4)
    assert max(page.evaluate("window.bindErrors()")) < 1e-5


@shaded
def test_three_js_puts_all_joints_where_ours_are(page, show, tmp_path):
    walk = resample(samples.sample("walk_straight"), 30)
    save(walk, tmp_path / "walk.glb")
    show(tmp_path / "walk.glb")
    exact = joint_positions(walk)
    for frame in range(0, len(walk), 10):
        rows = page.evaluate("window.places", frame / walk.fps)
        assert [row[0] for row in rows] == list(walk.skeleton.names)
        assert np.abs(np.array([row[1:] for row in rows]) - exact[frame]).max() < 1e-4
    page.evaluate("window.draw", 2.0)
    shot = page.locator("canvas").screenshot()
    drawn = np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)
    clay = (drawn[..., 2] - drawn[..., 0] > 15).mean()  # the body is bluish, the rest is grey
    assert 0.02 < clay < 0.4
