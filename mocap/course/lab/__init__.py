"""The notebooks as a laboratory: what a student wrote is used, and what a student thought is kept.

Reading order (notebooks 00 to 19)
----------------------------------
 1. `slots`: the place of an exercise, in which a student's function runs, or the package's in its stead
 2. `adopting`: a student's function drives the course from the exercise on; the package's stands in before
 3. `kept_functions`: the file beside the notebooks that keeps what students wrote, with all that it needs
 4. `rewritten`: functions of `mocap.plain` that call the exercises
 5. `program`: the text of `mocap.plain` with these functions, which ends `my_graph.py`
 6. `own`: this program, run with the student's functions, from clips to a walk along a path
 7. `seam_of_one`: the two walks of one person, and the seam between them, that a reader follows from 00 to 08
 8. `questions`: the questions of a notebook, as its file has them, with numbers that the notebook computes
 9. `asking`: quizzes with hints, and bets: what a reader thought, what came out, and how a page shows both
10. `choices`: which two windows are looked at, and what lies around them
11. `showing`: the widget, its picture and its sentence, and all that its page needs
12. `sensitivity`: d′ of a person, and of a class as one curve, with confidence intervals
13. `blind_tests`: the test in a notebook or on a page, and its films: with a seam, and controls without one

References
----------
.. [CP34] C. J. Clopper, E. S. Pearson, *The Use of Confidence or Fiducial Limits Illustrated in the Case of
   the Binomial*, Biometrika 26(4), 1934, doi 10.1093/biomet/26.4.404.
.. [Hau95] M. J. Hautus, *Corrections for Extreme Proportions and Their Biasing Effects on Estimated Values of
   d′*, Behavior Research Methods, Instruments, & Computers 27(1), 1995, doi 10.3758/BF03203619.
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
.. [MC05] N. A. Macmillan, C. D. Creelman, *Detection Theory: A User's Guide*, 2nd edition, Lawrence Erlbaum
   2005, chapter 7.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
