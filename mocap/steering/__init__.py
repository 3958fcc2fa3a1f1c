"""Steering: walks along paths, through waypoints and in crowds, and characters that obey commands.

Search for a walk: the path objective defines the requests and the cost of each deviation, a layered search
finds a walk of low cost, and `follow_path` combines the two. `waypoints_and_crowds` calls it. A new kind of
request is a field of `PathRequest`, with its price in `Settings` and its cost in
`PathSearch.macro_edge_costs`.

Control of a character: all characters implement the protocol `Character`, whose `step` takes a heading and a
speed and returns the next pose. Therefore code that steers, records or measures one of them works for all. A
new kind of control is a class with the same members, in a file of its own.

Reading order (notebooks 08, 12, 17, 18)
----------------------------------------
 1. `path_objective`: a path, the requests along it, and the prices of deviations
 2. `layered_search`: beam search over many walks, stored as arrays and extended together
 3. `path_search`: the costs of walks along a path, and the selection of those to extend
 4. `followed`: a walk along a path, and measures of its distance from the path
 5. `smooth_paths`: the paths of clips and walks without the sway of the root
 6. `bent_following`: walks that are bent onto a path
 7. `path_following`: search for a walk along a path, by layers and by the paper's branch and bound
 8. `waypoints_and_crowds`: waypoints with labels and times, and characters that avoid each other
 9. `seam_replacing`: walks without some of their seams
10. `standing`: standing stretches as part of a graph
11. `waiting`: walks through standing stretches that last a given time
12. `detours`: lines around discs
13. `direction_search`: prices of headings, discs, and the time and place of arrival
14. `anchoring`: corrections that are spread over the steps of a walk
15. `direction_legs`: the parts of a direction between the places where it waits
16. `directed_walk`: a walk that follows a direction, how it arrives, and what was corrected
17. `leg_search`: search for one leg of a direction
18. `directing`: walks that follow a direction: they stand, wait, turn and arrive
19. `characters`: the protocol, the pose of a step, a walk by given commands, and the delay of its response
20. `look_ahead`: walks ahead of a character on a motion graph, and their costs
21. `graph_control`: a character on a motion graph
22. `plain_vectors`: vectors and rotations in plain numbers
23. `leg_reach`: inverse kinematics of a leg in closed form
24. `held_feet`: standing feet are held while a character moves on
25. `root_turning`: the way to steer: additional rotation about the root, longer or shorter steps, held feet
26. `foot_turning`: additional rotation about the planted foot, as a comparison
27. `judged_control`: one evaluation protocol for all characters
28. `tuned`: the constants that trials chose

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
.. [KSG02] L. Kovar, J. Schreiner, M. Gleicher, *Footskate Cleanup for Motion Capture Editing*, SCA 2002,
   doi 10.1145/545261.545277.
.. [TGB00] D. Tolani, A. Goswami, N. Badler, *Real-Time Inverse Kinematics Techniques for Anthropomorphic
   Limbs*, Graphical Models 62, 2000, doi 10.1006/gmod.2000.0528.
.. [Bol18] D. Bollo, *Inertialization: High-Performance Animation Transitions in Gears of War*, GDC 2018.
.. [Gle01] M. Gleicher, *Motion Path Editing*, I3D 2001, doi 10.1145/364338.364400.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
