"""The command `mocap`: a function for each of its commands.

Reading order
-------------
1. `typed_commands`: how a typed function becomes a command of the library `cyclopts`
2. `messages`: what a command says beside its results, with `-q`, `-v` and `--debug`
3. `options`: what the commands share: options, clips that are read, files to write
4. `graph`: `mocap demo`, and motion graphs that are built, saved and described
5. `walk`: characters that walk through a graph, one or a crowd
6. `clips`: `mocap info`, `view`, `judge`, `convert` and `find`
7. `data`: `mocap data` lists and downloads clips of other labs
8. `edits`: `mocap warp`, `bend`, `loop`, `blend` and `retarget`
9. `course`: `mocap course` hands out, marks, publishes and runs the notebooks; `mocap lab` opens them
10. `help_pages`: help in plain text
11. `refusals`: what is told of words that fit no command, and what may have been meant
12. `streams`: output that is closed, full, or left by its reader
13. `main`: all of them under one name, with `mocap completion` and the exit status
"""
