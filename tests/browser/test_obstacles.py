"""Obstacles lie on the ground of the player."""

import io

import numpy as np
from PIL import Image

from mocap.widgets.player import play
from tests.browser.conftest import wait_until
from tests.strategies import wave


def test_an_obstacle_lies_on_the_ground_where_it_is(page, tmp_path):
    file = tmp_path / "page.html"
    file.write_text(play(wave(30), discs=[[0, 0.5, 0.4]]).page(), "utf-8")
    page.goto(file.as_uri())
    wait_until(lambda: page.evaluate("document.querySelector('.mocap-player').player?.pictures > 0"))
    middle = page.evaluate("""() => {
        const { camera } = document.querySelector('.mocap-player').player;
        return camera.pixel(camera.see(0.15, 0, 0.5));
    }""")
    shot = Image.open(io.BytesIO(page.locator("canvas").screenshot())).convert("RGB")
    x, y = np.round(middle).astype(int)
    around = np.asarray(shot)[y - 3 : y + 4, x - 3 : x + 4]
    assert (np.abs(around.astype(int) - 0xBB) < 3).all()
