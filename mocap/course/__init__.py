"""The notebooks of the course as data, and the checks of their exercises.

Teachers hand the notebooks out and publish them; `marking` marks them. Authors run them again, with the
package's own code in their cells. The command `mocap course` does all of this. A new exercise is four
cells of a notebook, with the tags that `notebooks` lists, and in `checks` what it asks for, the right answer,
and the typical mistakes with their hints.

Reading order
-------------
1. `guarded_calls`: calls of a student's function that cannot stop or freeze the notebook
2. `comparisons`: whether two answers are the same, and whether an argument was changed
3. `common_mistakes`: the right values in another form, order, unit or sign
4. `failing_inputs`: the smallest input on which a function fails, in one sentence
5. `check`: how an exercise is checked
6. `checks`: the exercises: words and functions of each notebook
7. `real_clips`: captured clips for notebooks that can do without, and the four collections of claims
8. `seam_trials`: walks by a matrix, and blends of matches drawn at random, measured
9. `marked_values`: numbers in prose, and the expressions that compute them
10. `notebooks`: read a notebook, find its cells by their tags and the names that they use, run it
11. `written`: answers in words, which a person reads
12. `copies`: what a new version changes in a reader's copy, a notebook given anew, and progress
13. `opening`: the course in JupyterLab, and in JupyterLite
14. `student_wheel`: the package as a file for students, and the requirement that installs it
15. `handout`: copies without solutions
16. `formulas`: formulas as MathML
17. `recording`: positions of an experiment, as pictures for pages without Python
18. `live_bodies`: small experiments on rotations and bodies, computed as on pages without Python
19. `live_walks`: small experiments on graphs and walks, computed alike
20. `live_experiments`: the table of these experiments, with their controls
21. `shared_files`: pictures and scripts of the site that its pages share
22. `search_texts`: the sentences of its pages, from which the search shows excerpts
23. `site`: the course as HTML pages, beside the reference pages of the package
24. `conf`: how Sphinx makes these pages
25. `diagrams`: ideas drawn step by step
26. `lab`: what students wrote is used, and what they thought is kept
27. `marking`: marks for notebooks handed in, whose code runs sealed
28. `exam`: an exam whose numbers a teacher's key draws, and the sheet to mark it with
29. `teaching`: slides and films that are made from the notebooks

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
