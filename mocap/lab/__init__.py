"""The notebooks as a laboratory: what a student wrote is used, and what a student thought is kept.

Reading order
-------------
1. `adopting`: a student's function drives the course from the exercise on; the package's stands in before
2. `guarding`: the place of an exercise: whose function runs there, and the guard around it
3. `kept_functions`: the file beside the notebooks that keeps what students wrote
4. `plain_source`: a function's source with its imports and helpers
5. `own`: a motion graph made of these functions alone, from clips to a walk along a path
6. `questions`: quizzes that mark themselves, and bets that are kept
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=["own"],
    submod_attrs={
        "adopting": ["mine", "whose"],
        "questions.quizzes": ["quiz"],
        "questions.kept_bets": ["bet", "bets"],
    },
)
