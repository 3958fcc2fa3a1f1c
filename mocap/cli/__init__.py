"""The command `mocap`: a function for each of its commands.

Reading order
-------------
1. `typed_commands`: conversion of a typed function to a command of the library `cyclopts`
2. `messages`: messages besides the results, with `-q`, `-v` and `--debug`
3. `clip_sets`: clips that are read together: those left out, their names, their unit and vertical axis
4. `options`: shared parts of the commands: options, reading of clips, checks of output files
5. `clusters`: the workers of a Dask cluster
6. `graph`: `mocap demo` and `mocap graph`, which build, save and describe motion graphs
7. `walk`: `mocap walk`, `page` and `crowd`, which walk through a graph
8. `clip_reports`: the numbers of clips, for `mocap info --json`
9. `clips`: `mocap info`, `view`, `judge`, `convert` and `find`
10. `data`: `mocap data`, which lists and downloads clips of other labs
11. `edits`: `mocap warp`, `bend`, `loop`, `blend` and `retarget`
12. `cutting`: `mocap cut`, which cuts, resamples, mirrors and repeats clips
13. `in_betweens`: `mocap inbetween`, which fills the time between two clips
14. `course`: `mocap course`, which hands out, marks, publishes and runs the notebooks, and `mocap lab`
15. `help_pages`: help in plain text
16. `refusals`: errors for invalid commands, options and values, with suggestions
17. `streams`: output streams that are closed, full, or abandoned by their reader
18. `main`: all commands under one name, with `mocap completion` and the exit status
19. `tuned`: the constants that trials chose
"""
