"""Pictures, by matplotlib: stick figures, distance images, paths, curves and graphs.

Every function draws on `ax` (new axes by default), computes nothing of its own, and returns the artists that
it made, or the axes; `show` puts the picture into a notebook with a sentence for readers who do not see it.

Reading order (notebooks 00 to 19)
----------------------------------
1. `style`: colours that colour-blind readers can tell apart
2. `bodies`: bodies as lines, on flat axes, and a whole walk in one picture
3. `stick_figures`: bodies on 3D axes with a ground
4. `grids`: distances and costs as images
5. `charts`: curves and bands; paths and ways from above
6. `graph_drawing`: motion graphs as timelines and as nodes with arrows
7. `picture`: a figure as a picture in a notebook

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

import lazy_loader

_names = {
    "style": ["ASKED", "COLOURS", "CURVES", "FLOOR", "MARK", "PATH", "QUIET", "SOURCES"],
    "bodies": ["bones", "flat_bodies"],
    "stick_figures": ["StickFigure", "ground_axes"],
    "grids": ["distance_image", "walk_rows"],
    "charts": ["draw_group_plan", "joint_curve", "path_from_above", "quartile_band"],
    "graph_drawing": ["node_link", "timeline"],
    "picture": ["show"],
}
__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submod_attrs=_names)
