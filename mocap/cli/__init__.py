"""The command `mocap`: a function for each of its commands.

Reading order
-------------
1. `typed_commands`: conversion of a typed function to a command of the library `cyclopts`
2. `messages`: messages besides the results, with `-q`, `-v` and `--debug`
3. `clip_sets`: clips that are read together: those left out, their names, their unit and vertical axis
4. `option_types`: types of options, with conversion, bounds and help
5. `stages`: progress bars and durations
6. `outputs`: printed results, and files to write, which are checked before any work
7. `options`: groups of options by which commands read clips, paths and graphs
8. `clusters`: the workers of a Dask cluster
9. `graph`: `mocap demo` and `mocap graph`, which build, save and describe motion graphs
10. `walk`: `mocap walk`, `page` and `crowd`, which walk through a graph
11. `clip_reports`: the numbers of clips, for `mocap info --json`
12. `clips`: `mocap info`, `view`, `judge`, `convert` and `find`
13. `labels`: `mocap label`, which proposes labels for clips
14. `data`: `mocap data`, which lists and downloads clips of other labs
15. `edits`: `mocap warp`, `bend`, `loop`, `blend` and `retarget`
16. `cutting`: `mocap cut`, which cuts, resamples, mirrors and repeats clips
17. `in_betweens`: `mocap inbetween`, which fills the time between two clips
18. `course`: `mocap course`, which hands out, marks, publishes and runs the notebooks, and `mocap lab`
19. `help_pages`: help in plain text
20. `refusals`: errors for invalid commands, options and values, with suggestions
21. `streams`: output streams that are closed, full, or abandoned by their reader
22. `main`: all commands under one name, with `mocap completion` and the exit status
23. `tuned`: the constants that trials chose
"""
