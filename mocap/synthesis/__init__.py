"""Synthesis: walks through a motion graph, at random or by search, and their conversion to motions.

A walk is a list of edges, each of which starts at the end of the previous one. `to_motion` converts it to a
motion. A new method to choose edges belongs in a file beside `random_walks`; methods that follow the request
of a user belong in `steering`.

Reading order (notebook 07)
---------------------------
1. `walk_to_motion`: conversion of a walk to a motion, its seams and its clips
2. `random_walks`: random walks, and hours of motion in constant memory
3. `bounded_search`: the walk of least cost by branch and bound, as in the paper
4. `ground_walks`: trajectories of walks on the ground, for searches
5. `walk_tables`: a table of the stretches and the seams of a walk
6. `tuned`: the constants that trials chose

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
