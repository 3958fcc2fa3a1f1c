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
10. `editing`: commands that change one clip: `mocap warp`, `mocap bend`, `mocap retarget`
11. `many_clips`: commands for many clips at once: `mocap find`, `mocap crowd`
12. `main`: all of them under one name
"""
