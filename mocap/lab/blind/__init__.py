"""Whether people see a seam: pairs of films, one with a seam, and how well a person tells which.

Reading order
-------------
1. `sensitivity`: d′ of a person, and of a class, with confidence intervals
2. `pairs`: films with a seam, and controls without one from the same clips at the same phase
3. `films`: pairs as data for the browser
4. `blind_tests`: the test in a notebook or on a page
5. `class_answers`: the files that a class saves, as one curve
"""
