"""Inputs, right answers and mistakes, a module for each notebook; the student's process cannot read them.

A module such as `nb06_pruning` has functions for each exercise, here `tarjan`:

- `draw_tarjan` draws the arguments of one call by a random generator.
- `right_tarjan` returns the right answer.
- `same_tarjan` compares two answers, if `mocap.course.comparisons.close` does not do.
- `mistake_...` are the wrong answers that `hints/06-pruning.toml` names below `[tarjan.mistakes]`. If several
  fit, the first one in that file counts.

`common` contains what several notebooks use. `searches` contains the search of notebook 07 and its variants.
"""
