"""In-betweening: motion from one pose to another, each at its position, in a given time.

An animator sets two poses and a time, and the frames between them are missing. A straight line between them
slides. Here a walk through a motion graph [KGP02] takes the character from the one to the other. Walks from
both poses that meet half-way are what the clips can do. The best of them are bent [Gle01], their steps are
lengthened, and their time is stretched; the one that changes least is kept. Its ends fade into the poses, and
its feet are cleaned up [KSG02].

The papers follow a path. That a walk arrives at a pose in time is ours: the search from both sides, the
bending to an end, and the ends that fade.

Reading order
-------------
1. `end_bending`: a walk bent and retimed so that it ends where it must
2. `two_sided_search`: frames similar to two poses, and walks from both that meet
3. `end_poses`: ends that become the poses, and feet that stand still
4. `planted_feet`: the last millimetre by which feet slide
5. `in_betweens`: the whole: search, bend, fade
6. `interpolation`: gaps so short that a curve does better
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
