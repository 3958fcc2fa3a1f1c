"""The command `mocap`: a function for each of its commands.

Reading order
-------------
1. `typed_commands`: how a typed function becomes a command of the library `cyclopts`
2. `messages`: what a command says beside its results, with `-q`, `-v` and `--debug`
3. `options`: what the commands share: options, clips that are read, files to write
4. `clusters`: the workers of a Dask cluster
5. `graph`: `mocap demo`, and motion graphs that are built, saved and described
6. `walk`: characters that walk through a graph, one or a crowd
7. `clips`: `mocap info`, `view`, `judge`, `convert` and `find`
8. `data`: `mocap data` lists and downloads clips of other labs
9. `edits`: `mocap warp`, `bend`, `loop`, `blend` and `retarget`
10. `in_betweens`: `mocap inbetween` fills the time between two clips
11. `course`: `mocap course` hands out, marks, publishes and runs the notebooks; `mocap lab` opens them
12. `help_pages`: help in plain text
13. `refusals`: the errors for words that fit no command, with suggestions
14. `streams`: output that is closed, full, or left by its reader
15. `main`: all of them under one name, with `mocap completion` and the exit status
16. `tuned`: the constants that trials chose
"""
