"""Diagrams: an idea drawn before its formula, step by step.

Each function draws one idea and returns a figure. Where the idea has steps, the parameter `step` says how
many of them are drawn, so that an experiment can show them one after the other. A new diagram is a function
in the file of its subject.

Reading order (notebooks 00 to 09)
----------------------------------
 1. `small_graphs`: nodes and edges on two clips, and Tarjan's search on the paper's small graph
 2. `poses`: two half turns, turns whose order matters, and forward kinematics by joint
 3. `windows`: what a window is, bounds and sums over windows, and a transition in panels
 4. `laying_clouds`: one cloud of points laid on another, from above
 5. `ground`: one clip aligned with another, and how far a walk is from its path, from above
 6. `seams`: frames of a transition, ways between two rotations, a leg as a triangle, and added jolts
 7. `branching`: the walks that branch and bound takes up, and walks from above
 8. `layers`: the layered search along a line, with the line of its code that runs
 9. `pens`: arrows, words and discs that several of them share

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
