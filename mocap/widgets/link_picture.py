"""The picture that a link to a walking page shows."""

import io

from PIL import Image

from mocap.body.ground_path import s_curve
from mocap.graphs.motion_graph import MotionGraph
from mocap.synthesis.random_walks import random_walk
from mocap.widgets.filmed_scene import FilmedScene
from mocap.widgets.player import play
from mocap.widgets.walk_bending import bend_onto

SIZE = (1200, 630)  # pixels, the size that services show
BODY = "#3b5a8c"  # the colours of the page
LEFT = "#4a6fa8"
RIGHT = "#304a76"
LINE = "#e2502a"
LENGTH = 7.0  # metres of the line
SPEED = 1.2  # metres per second
SEED = 1  # of the walk


def link_picture(graph: MotionGraph) -> bytes:
    """Draw a figure on its way along a line, as a PNG of 1200 x 630 pixels.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> graph = graphs.prune(graphs.build([clip], window=10, threshold=0.04))
    >>> link_picture(graph)[1:4]
    b'PNG'
    """
    edges = random_walk(graph, seconds=LENGTH / SPEED, seed=SEED)
    scene = play(bend_onto(graph, edges, s_curve(LENGTH))).scene
    scene["sides"] = [LINE, LEFT, RIGHT]
    scene["characters"][0] |= {"colour": BODY, "path_colour": LINE, "seams": []}
    film = FilmedScene(scene)
    picture = io.BytesIO()
    Image.fromarray(film.picture(film.seconds / 2, SIZE)).save(picture, "PNG", optimize=True)
    return picture.getvalue()
