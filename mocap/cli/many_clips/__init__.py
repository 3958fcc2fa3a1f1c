"""Commands for many clips at once.

Reading order
-------------
1. `find`: `mocap find`, all motions like an example
2. `crowd`: `mocap crowd`, a group that was planned
"""
