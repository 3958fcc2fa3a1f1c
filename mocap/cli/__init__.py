"""The command `mocap`: a function for each of its commands.

Reading order
-------------
 1. `typed_commands`: how a typed function becomes a command
 2. `options`: what the commands share: options, clips that are read, files to write
 3. `demo`: clips in, a new walk out
 4. `graph`: build a motion graph and save it, or describe a saved one
 5. `walk`: a walk through a saved graph, along a path or at random
 6. `blend`: clips blended as wholes, or one that passes into another
 7. `files`: `mocap info`, `mocap judge`, `mocap convert`, `mocap data`
 8. `edits`: `mocap warp` and `mocap bend`, which change one clip
 9. `retarget`: one body wears the clips of others
10. `loop`: the best cycle in a clip, closed
11. `view`: play a clip in the browser
12. `find`: all motions like an example
13. `crowd`: a group that was planned, and a character for each member
14. `course`: `mocap course` hands out, marks, publishes and runs the notebooks; `mocap lab` opens them
15. `main`: all of them under one name
"""
