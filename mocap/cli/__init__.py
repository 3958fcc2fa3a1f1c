"""The command `mocap`: a file for each of its commands.

Reading order
-------------
 1. `options`: what the commands share
 2. `demo`: clips in, a new walk out
 3. `graph`: build a motion graph and save it, or describe a saved one
 4. `walk`: a walk through a saved graph, along a path or at random
 5. `blend`: clips blended as wholes, or one that passes into another
 6. `files`: `mocap info`, `mocap judge`, `mocap convert`, `mocap data`
 7. `loop`: the best cycle in a clip, closed
 8. `view`: play a clip in the browser
 9. `course`: `mocap course` hands out, marks, publishes and runs the notebooks; `mocap lab` opens them
10. `main`: all of them under one name
11. `warp`: `mocap warp`, keys out of a small text file
12. `bend`: `mocap bend`, a walk laid on a line
13. `retarget`: `mocap retarget`, one body wears the clips of others
14. `find`: `mocap find`, all motions like an example
15. `crowd`: `mocap crowd`, a group that was planned
"""
