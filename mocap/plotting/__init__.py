"""Plots with matplotlib: stick figures, distance images, paths, curves and graphs.

Each function draws on `ax`, by default new axes, and returns the artists that it added, or the axes.
Functions only draw: quantities are computed elsewhere. `show` displays a picture in a notebook, with an
alternative text for readers who do not see it.

Reading order (notebooks 00 to 19)
----------------------------------
1. `style`: colours that colour-blind readers can distinguish
2. `props`: discs on the ground and boxes, as polygons
3. `bodies`: bodies as lines, on flat axes, and a whole walk in one picture
4. `stick_figures`: bodies on 3D axes with a ground
5. `grids`: distances and costs as images
6. `charts`: curves, bands, and paths seen from above
7. `graph_drawing`: motion graphs as timelines and as nodes with arrows
8. `picture`: a figure as a picture in a notebook

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
