"""What a moving body is: a skeleton, its pose in every frame, and how to turn and move it.

A `Motion` is a `Skeleton` plus arrays: where the root is and how each joint is turned, frame by frame. All
other rooms stand on this one.

Reading order (notebooks 01, 03)
--------------------------------
1. `skeleton`: a tree of joints
2. `motion`: the body over time; other frame rates; clips in a row
3. `rotations`: unit quaternions (w, x, y, z) as arrays: product, slerp, conversions
4. `joint_trees`: from rotations to where every joint is, and velocities, as arrays
5. `kinematics`: the same of a motion: forward kinematics; which joints are hinges
6. `planar`: turns about the vertical and moves over the ground
7. `euler`: Euler angles and their traps
8. `ground_path`: lines on the ground, by metres along them
9. `limbs`: which joints are the legs, where their hips head, and which joint of a body does what
10. `fingerprints`: what a clip is known by, whatever it is called

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
