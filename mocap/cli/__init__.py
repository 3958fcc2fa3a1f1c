"""The command `mocap`: a function for each of its commands.

Reading order
-------------
1. `typed_commands`: how a typed function becomes a command
2. `options`: what the commands share: options, clips that are read, files to write
3. `clusters`: the workers of a Dask cluster
4. `graph`: `mocap demo`, and motion graphs that are built, saved and described
5. `walk`: characters that walk through a graph, one or a crowd
6. `clips`: `mocap info`, `view`, `judge`, `convert` and `find`
7. `data`: `mocap data` lists and downloads clips of other labs
8. `edits`: `mocap warp`, `bend`, `loop`, `blend` and `retarget`
9. `in_betweens`: `mocap inbetween` fills the time between two clips
10. `course`: `mocap course` hands out, marks, publishes and runs the notebooks; `mocap lab` opens them
11. `main`: all of them under one name
"""
