"""The notebooks as data, and the checks of their exercises.

For those who teach: hand the notebooks out, mark them, publish them. For those who write them: run them anew,
with the package's own code in their cells.

Reading order
-------------
1. `check`: how an exercise is checked
2. `checks`: the checks, a file for each notebook
3. `homework_slips`: five slips of the homework, and what fixes them
4. `notebooks`: cells by their tags; running them
5. `handout`: hand out and mark
6. `site`: the course as HTML pages
7. `lite`: the course in JupyterLite
8. `lab`: the course in JupyterLab
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=["checks", "homework_slips"],
    submod_attrs={
        "check": ["Check", "Mistake", "Verdict"],
        "homework_slips": [
            "chain_on_last",
            "euler_from_zero_to_pi",
            "homework_heading",
            "lay_in_full",
            "turn_in_place",
        ],
        "notebooks": ["read", "run", "shown_source", "tagged"],
        "handout": ["Mark", "hand_out", "mark", "to_csv"],
        "site": ["build_site"],
        "lite": ["build_lite"],
        "lab": ["open_course", "stored"],
    },
)
