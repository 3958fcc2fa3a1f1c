"""What plays on a page, whatever it is."""

import json
import re

import pytest

from mocap.course.lab.showing import inspector
from mocap.plotting.picture import Picture
from mocap.widgets.embedding import Embedded
from mocap.widgets.player import play
from tests.strategies import wave

SCENE = {"name": "</script>", "data": b"waves"}
KINDS = {"player": play(wave(30)), "inspector": inspector(wave(60), at=(5, 30), window=6)}


class Ship(Embedded):
    alt, picture, scene, scripts = 'A <ship> & "sea".', b"PNG", SCENE, ()


@pytest.mark.parametrize("kind", KINDS)
def test_the_scripts_of_each_kind_start_its_class(kind):
    page = KINDS[kind].page()
    assert f'<div class="mocap-{kind}">' in page
    assert f"class {kind.title()} " in page and f"start({kind.title()});" in page
    assert page.count("function start(") == 1


def test_a_page_holds_the_scene_the_picture_and_the_sentence():
    page, alt = Ship().page(), "A &lt;ship&gt; &amp; &quot;sea&quot;."
    scene = json.loads(re.search(r'<script type="application/json">(.*?)</script>', page)[1])
    assert scene == SCENE | {"data": "d2F2ZXM="}
    assert f"<title>{alt}</title>" in page and "<h1>" not in page
    assert f'<div class="mocap-ship"><img alt="{alt}" src="data:image/png;base64,UE5H">' in page
    assert repr(Ship()) == f"Ship({Ship.alt!r})"
    bundle, metadata = Ship()._repr_mimebundle_()
    still, same = Picture(b"PNG", Ship.alt)._repr_mimebundle_()
    assert bundle == still | {"text/html": Ship().html()} and metadata == same
