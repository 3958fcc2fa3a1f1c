"""Motions: a skeleton, its pose in every frame, and the rotations and transforms that move it.

A `Motion` is a `Skeleton` plus arrays: the root's position and each joint's rotation in every frame. All
other rooms build on this one.

Reading order (notebooks 01, 03)
--------------------------------
 1. `skeleton`: a tree of joints
 2. `motion`: the pose in every frame, and resampling
 3. `concatenation`: motions one after the other, on one skeleton and at one frame rate
 4. `rotations`: unit quaternions (w, x, y, z) as arrays: product, slerp, conversions
 5. `joint_trees`: forward kinematics and velocities of arrays
 6. `kinematics`: forward kinematics of a motion, and detection of hinge joints
 7. `planar`: planar rigid transforms, and the heading of a body
 8. `euler`: Euler angles, gimbal lock, and continuity over frames
 9. `ground_path`: paths on the ground, parametrised by arc length
10. `legs`: the joints of a leg, and the heading of the hips
11. `limb_tree`: bones of constant length, and chains of them
12. `limb_pairs`: pairs of limbs, mirror images by their lengths
13. `limb_roles`: left and right, and the roles of the joints of a limb
14. `limb_search`: legs and arms by bones and motion, whatever the names of joints
15. `limbs`: legs and arms, and the role of each joint in a body
16. `foot_joints`: ankles, what is below them, and the tips of toes
17. `limb_partners`: joints of left and right limbs that are mirror images
18. `body_sides`: left, right and the head, by names or roles
19. `fingerprints`: hashes that identify a clip under any name
20. `tuned`: the constants that trials chose

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
