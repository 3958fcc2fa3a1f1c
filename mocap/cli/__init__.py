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
8. `saved_graphs`: saved graphs with their clips, also if these have moved
9. `clusters`: the workers of a Dask cluster
10. `graph`: `mocap demo` and `mocap graph`, which build, save and describe motion graphs
11. `directing`: options of `mocap walk` that direct a walk, and the table of a walk
12. `walk`: `mocap walk`, a walk along a path, as a direction says, or at random
13. `steer`: `mocap steer`, a page on which a figure is steered and recorded
14. `page`: `mocap page`, a web page on which a figure walks
15. `crowd`: `mocap crowd`, groups that walk
16. `clip_reports`: the numbers of clips, for `mocap info --json`
17. `clips`: `mocap info`, `view`, `judge`, `convert` and `find`
18. `labels`: `mocap label`, which proposes labels for clips
19. `data`: `mocap data`, which lists and downloads clips of other labs
20. `edits`: `mocap warp`, `bend`, `loop`, `blend` and `retarget`
21. `cutting`: `mocap cut`, which cuts, resamples, mirrors and repeats clips
22. `in_betweens`: `mocap inbetween`, which fills the time between two clips
23. `course`: `mocap course`, which hands out, marks, publishes and runs the notebooks, and `mocap lab`
24. `help_pages`: help in plain text
25. `refusals`: errors for invalid commands, options and values, with suggestions
26. `streams`: output streams that are closed, full, or abandoned by their reader
27. `main`: all commands under one name, with `mocap completion` and the exit status
28. `tuned`: the constants that trials chose
"""
