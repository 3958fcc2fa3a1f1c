"""The commands that change one clip.

Reading order
-------------
1. `warp`: `mocap warp`, keys out of a small text file
2. `retarget`: `mocap retarget`, one body wears the clips of others
"""
