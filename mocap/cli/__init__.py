"""The command `mocap`: a function for each of its commands.

Reading order
-------------
1. `typed_commands`: how a typed function becomes a command
2. `options`: what the commands share: options, clips that are read, files to write
3. `graph`: `mocap demo`, and motion graphs that are built, saved and described
4. `walk`: characters that walk through a graph, one or a crowd
5. `clips`: `mocap info`, `view`, `judge`, `convert` and `find`
6. `data`: `mocap data` lists and downloads clips of other labs
7. `edits`: `mocap warp`, `bend`, `loop`, `blend` and `retarget`
8. `in_betweens`: `mocap inbetween` fills the time between two clips
9. `course`: `mocap course` hands out, marks, publishes and runs the notebooks; `mocap lab` opens them
10. `main`: all of them under one name
"""
