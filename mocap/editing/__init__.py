"""The motion itself, edited: displacement maps, pins, and the four papers that build on them.

A motion graph can only turn where its clips turn. Here a captured motion is changed: a pose is moved at a key
[WP95], a walk is laid on another path [Gle01], a motion is worn by another body [Gle98], a foot steps on a
stone [LS99]. All four add a displacement map to a motion: a smooth curve for the root and for each joint.

Reading order (notebooks 10 to 14)
---------------------------------
 1. `displacements`: what an edit adds to a motion, and the splines that keep it smooth
 2. `turns`: how a joint is turned, as a position in metres
 3. `pins`: where joints shall be, and for how long
 4. `bodies`: which joints may turn, about which axes, at what price; limits, and orientations that are kept
 5. `toes`: toes that bend so that their tips stay above the floor
 6. `solver`: how a change may run over time; the smallest smooth one, for each frame by itself or for all
 7. `edits`: a calm change, to the last digit; one pose, made by dragging joints; levels, from coarse to fine
 8. `path_editing`: the path of a motion, and the motion on another path
 9. `turning`: slower in bends, and leaning in, as people take them
10. `line_rounding`: lines rounded where a walk would turn too fast
11. `bending`: a walk bent to any line, with feet that stand
12. `keys`: keys, the curve through them, and warps by offsets and by scale
13. `retiming`: time keys, and motions at moments between their frames
14. `warp_plans`: a whole warp from a small text file
15. `foot_heights`: heights of ankles and balls that stand
16. `stances`: the stance of a body, from its rest pose, a pose, or a walk
17. `proportions`: bodies with longer or shorter limbs
18. `retargeting`: global rotations copied to another body, and constraints for its feet
19. `mirroring`: left and right exchanged, by names and geometry
20. `cycles`: the best cycle of a clip, closed by a blend
21. `travel`: the travel on the ground, removed
22. `tuned`: the constants that trials chose

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
