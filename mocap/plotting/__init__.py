"""Pictures, by matplotlib: stick figures, distance images, paths, curves and graphs.

Every function draws on `ax` (new axes by default), and returns the artists that it made, or the axes. It
computes nothing but the picture. `show` puts the picture into a notebook, with a sentence for readers who do
not see it.

Reading order (notebooks 00 to 19)
----------------------------------
1. `style`: colours that colour-blind readers can tell apart
2. `bodies`: bodies as lines, on flat axes, and a whole walk in one picture
3. `stick_figures`: bodies on 3D axes with a ground
4. `grids`: distances and costs as images
5. `charts`: curves and bands; paths seen from above
6. `graph_drawing`: motion graphs as timelines and as nodes with arrows
7. `picture`: a figure as a picture in a notebook

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
