"""In-betweening: motion from one pose to another, each at its position, in a given time.

An animator sets two poses and a time, and the frames between them are missing. With a straight line between
them the feet slide. Here a walk through a motion graph [KGP02] takes the character from the first pose to the
second. A search from both poses finds walks that meet half-way. The best of them are bent [Gle01], their
steps are lengthened, and their time is warped. The walk with the smallest changes is selected. Its ends are
blended into the poses, and foot sliding is removed [KSG02].

The papers follow a path. Arrival at a pose in a given time is ours: the search from both sides, the bending
to an end, and the blending of the ends.

Reading order
-------------
1. `end_bending`: bending and retiming of a walk so that it ends at a given position
2. `two_sided_search`: frames similar to two poses, and walks from both that meet
3. `end_poses`: blending of the ends into the poses, and removal of foot sliding
4. `planted_feet`: removal of the last millimetre of foot sliding
5. `in_betweens`: the complete method: search, bend, blend
6. `interpolation`: cubic curves for short gaps
7. `tuned`: the constants that trials chose

References
----------
.. [Gle01] M. Gleicher, *Motion Path Editing*, I3D 2001, doi 10.1145/364338.364400.
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
.. [KSG02] L. Kovar, J. Schreiner, M. Gleicher, *Footskate Cleanup for Motion Capture Editing*, SCA 2002,
   doi 10.1145/545261.545277.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
