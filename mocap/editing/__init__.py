"""The motion itself, edited: displacement maps, constraints, and the four papers that build on them.

A motion graph can only turn where its clips turn. Here a captured motion is changed: a pose is moved at a key
[WP95], a walk is laid on another path [Gle01], a motion is worn by another body [Gle98], a foot steps on a
stone [LS99]. All four add a displacement map to a motion: a smooth curve for the root and for each joint.

Reading order (notebooks 10 to 14)
---------------------------------
 1. `displacements`: displacement maps, which an edit adds to a motion, and the splines that keep them smooth
 2. `poses`: a motion with its joints in the world, computed once and handed on
 3. `boxes`: constraints of two kinds, on positions and on rotations, with their values and Jacobians
 4. `constraints`: all constraints as one value, and their rows in the least squares
 5. `constraint_checks`: whether a pose can meet constraints, and their errors
 6. `pins`: the constraints that edits use: footplants, rails, floors, limits, orientations
 7. `bodies`: which joints may rotate, about which axes, at what price
 8. `stages`: the stages of the solver, the curves of each, and their banded least squares
 9. `solver`: its stages; the smallest smooth change that meets constraints, for single frames or all together
10. `toes`: toes that bend so that their tips stay above the floor
11. `standing`: what keeps standing under an edit: plants, a floor, and marks that are true
12. `above_floor`: the one pass of all edits: solved for, with bent toes, above a floor
13. `edits`: a smooth change that meets constraints exactly
14. `foot_cleaning`: feet that do not slide, and joints that are not under the floor
15. `posing`: a single pose, made by dragging joints
16. `levels`: constraints met level by level, from coarse to fine
17. `path_editing`: the path of a motion, and the motion on another path
18. `turning`: slower in bends, and leaning in, as people take them
19. `line_rounding`: lines rounded where a walk would turn too fast
20. `bending`: a walk bent to any line, with feet that stand
21. `keys`: keys, the curve through them, and warps by offsets and by scale
22. `retiming`: time keys, and motions at moments between their frames
23. `warp_plans`: a whole warp from a small text file
24. `foot_heights`: heights of ankles and balls that stand
25. `stances`: the stance of a body, from its rest pose, a pose, or a walk
26. `proportions`: bodies with longer or shorter limbs
27. `pose_copying`: global rotations and the path of the hips, copied to another body
28. `retargeting`: a copied motion, changed until its feet stand on the floor
29. `mirroring`: left and right exchanged, by names and geometry
30. `cycles`: the best cycle of a clip, closed by a blend
31. `travel`: the travel on the ground, removed
32. `tuned`: the constants that trials chose

References
----------
.. [Gle01] M. Gleicher, *Motion Path Editing*, I3D 2001, doi 10.1145/364338.364400.
.. [Gle98] M. Gleicher, *Retargetting Motion to New Characters*, SIGGRAPH 1998, doi 10.1145/280814.280820.
.. [LS99] J. Lee, S. Y. Shin, *A Hierarchical Approach to Interactive Motion Editing for Human-like Figures*,
   SIGGRAPH 1999, doi 10.1145/311535.311539.
.. [LWS97] S. Lee, G. Wolberg, S. Y. Shin, *Scattered Data Interpolation with Multilevel B-Splines*, IEEE TVCG
   3(3), 1997, doi 10.1109/2945.620490.
.. [WP95] A. Witkin, Z. Popović, *Motion Warping*, SIGGRAPH 1995, doi 10.1145/218380.218422.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
