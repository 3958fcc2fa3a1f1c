"""The notebooks as a laboratory: what a student wrote is used, and what a student thought is kept.

Reading order (notebooks 00 to 19)
----------------------------------
1. `adopting`: a student's function drives the course from the exercise on; the package's stands in before
2. `guarding`: the place of an exercise: whose function runs there, and the guard around it
3. `kept_functions`: the file beside the notebooks that keeps what students wrote
4. `plain_source`: a function's source with its imports and helpers
5. `own`: a motion graph made of these functions alone, from clips to a walk along a path
6. `questions`: quizzes that mark themselves, and bets that are kept
7. `inspecting`: the transition inspector, to point at two windows and see their seam
8. `blind`: whether people see a seam, asked by pairs of films

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

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=["own"],
    submod_attrs={
        "inspecting.showing": ["Inspector", "inspector"],
        "adopting": ["mine", "whose"],
        "questions.quizzes": ["quiz"],
        "questions.kept_bets": ["bet", "bets"],
        "blind.blind_tests": ["blind_test"],
        "blind.class_answers": ["class_curve", "read_answers"],
        "blind.sensitivity": ["d_prime"],
    },
)
