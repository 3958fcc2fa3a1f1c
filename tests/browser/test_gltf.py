"""A `.glb` in three.js, as a viewer shows it: all joints are where ours are, and there is somebody to see."""

import io
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mocap.body import joint_positions, resample
from mocap.datasets import samples
from mocap.files.load_save import save
from tests.browser.conftest import shaded, wait_until

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


@shaded
def test_three_js_puts_all_joints_where_ours_are(page, three, tmp_path):
    walk = resample(samples.sample("walk_straight"), 30)
    save(walk, tmp_path / "walk.glb")

    def answer(route):
        name = route.request.url.removeprefix(ADDRESS + "/")
        here = {"": PAGE, "walk.glb": tmp_path / "walk.glb"}
        route.fulfill(path=here.get(name) or three.parent / name)

    page.route(f"{ADDRESS}/**", answer)
    page.goto(f"{ADDRESS}/")
    wait_until(lambda: page.evaluate("window.ready"))
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
