"""The command `mocap`: a function for each of its commands.

Reading order
-------------
1. `typed_commands`: conversion of a typed function to a command of the library `cyclopts`
2. `messages`: messages besides the results, with `-q`, `-v` and `--debug`
3. `options`: shared parts of the commands: options, reading of clips, checks of output files
4. `clusters`: the workers of a Dask cluster
5. `graph`: `mocap demo` and `mocap graph`, which build, save and describe motion graphs
6. `walk`: `mocap walk`, `page` and `crowd`, which walk through a graph
7. `clips`: `mocap info`, `view`, `judge`, `convert` and `find`
8. `data`: `mocap data`, which lists and downloads clips of other labs
9. `edits`: `mocap warp`, `bend`, `loop`, `blend` and `retarget`
10. `in_betweens`: `mocap inbetween`, which fills the time between two clips
11. `course`: `mocap course`, which hands out, marks, publishes and runs the notebooks, and `mocap lab`
12. `help_pages`: help in plain text
13. `refusals`: errors for invalid commands, options and values, with suggestions
14. `streams`: output streams that are closed, full, or abandoned by their reader
15. `main`: all commands under one name, with `mocap completion` and the exit status
"""
