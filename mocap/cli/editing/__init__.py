"""The commands that change one clip.

Reading order
-------------
1. `warp`: `mocap warp`, keys out of a small text file
2. `bend`: `mocap bend`, a walk laid on a line
3. `retarget`: `mocap retarget`, one body wears the clips of others
"""
