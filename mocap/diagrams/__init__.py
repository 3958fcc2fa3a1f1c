"""Diagrams: an idea drawn before its formula, step by step.

Each function draws one idea and returns a figure. Where the idea has steps, the parameter `step` says how
many of them are drawn, so that an experiment can show them one after the other. A new diagram is a function
in the file of its subject.

Reading order (notebooks 00 to 09)
----------------------------------
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={},
)
