"""Moving bodies: a skeleton, its pose in every frame, and rotations and translations of it.

A `Motion` is a `Skeleton` plus arrays: the root's position and each joint's rotation, frame by frame. All
other rooms build on this one.

Reading order (notebooks 01, 03)
--------------------------------
1. `skeleton`: a tree of joints
2. `motion`: the body over time; other frame rates; clips in a row
3. `rotations`: unit quaternions (w, x, y, z) as arrays: product, slerp, conversions
 4. `joint_trees`: from rotations to the positions of all joints, and velocities, as arrays
 5. `kinematics`: the same of a motion: forward kinematics; which joints are hinges
 6. `planar`: rotations about the vertical with translations over the ground
 7. `euler`: Euler angles and their traps
 8. `ground_path`: lines on the ground, by metres along them
 9. `limb_tree`: bones that keep their lengths, and chains of them
10. `limb_search`: legs and arms by bones and motion, whatever joints are called
11. `limbs`: legs and arms, the heading of the hips, and the role of each joint in a body
12. `fingerprints`: hashes by which a clip is recognised under any name

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
