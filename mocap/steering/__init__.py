"""Steering: walks that follow a wish: along a path, through waypoints, in a crowd, by commands.

A walk that is searched for: the path objective says what is asked for and what each deviation costs, a
layered search finds the walk with the lowest cost, and `follow_path` joins the two; `waypoints_and_crowds`
calls it. A new kind of wish is a field of `Wishes`, with its price in `Settings` and its cost in
`PathSearch.hop_costs`.

A character that is commanded: all fit one protocol, `Character`; its `step` takes a heading and a speed and
gives the next pose. So whatever steers, records or measures one of them does so for all. A new way of control
is a class with the same members, in a file of its own.

Reading order (notebooks 08, 12, 17, 18)
----------------------------------------
 1. `path_objective`: a path, the wishes along it, and their prices
 2. `layered_search`: many walks as arrays, lengthened together
 3. `path_search`: what walks along a path cost, and which of them go on
 4. `followed`: the walk that was found along a path, and how well it follows the path
 5. `smooth_paths`: the paths of clips and walks without the sway of the root
 6. `bent_following`: walks that are bent onto a path
 7. `path_following`: find a walk along a path, in layers and by the paper's branch and bound
 8. `waypoints_and_crowds`: places, labels and times to pass; many characters that keep apart
 9. `characters`: the protocol, the pose that a step gives, a walk by given commands, how soon they are obeyed
10. `graph_control`: a character on a motion graph, and how it looks ahead
11. `foot_turning`: a character that turns about the foot that stands, beyond what its clips turn
12. `judged_control`: one protocol for all characters
13. `tuned`: the constants that trials chose

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
.. [Gle01] M. Gleicher, *Motion Path Editing*, I3D 2001, doi 10.1145/364338.364400.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
