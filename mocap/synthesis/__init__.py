"""Synthesis: find walks through a motion graph, at random or by search, and turn them into motions.

A walk is a list of edges; each edge starts where the one before ends. `to_motion` plays a walk. A new way to
choose edges belongs in a file beside `random_walks`; ways that follow a user's wish belong in `steering`.

Reading order (notebook 07)
---------------------------
1. `walk_to_motion`: turn a walk into a motion; its seams and the clips it plays
2. `random_walks`: choose transitions at random; make hours of motion, piece by piece
3. `bounded_search`: find the cheapest walk by branch and bound, as the paper does
4. `ground_walks`: trajectories of walks on the ground, for searches
5. `tuned`: the constants that trials chose

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
