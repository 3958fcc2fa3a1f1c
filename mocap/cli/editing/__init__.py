"""The commands that change one clip.

Reading order
-------------
1. `retarget`: `mocap retarget`, one body wears the clips of others
"""
