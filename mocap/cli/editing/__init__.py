"""The commands that change one clip.

Reading order
-------------
1. `warp`: `mocap warp`, keys out of a small text file
"""
