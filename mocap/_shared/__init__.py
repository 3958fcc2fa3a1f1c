"""Small things that all rooms need; there is no need to read them first.

1. `arrays`: names for kinds of arrays; read-only copies, runs of True, joined ranges
2. `ties`: values that only rounding tells apart are equal, and the first of equals is taken
3. `easing`: the curve that eases from 0 to 1
4. `atomic`: a file is written whole or not at all
5. `archives`: arrays in one file, unpacked only where it holds what it claims
6. `progress`: what functions take as `progress=`
7. `collector`: pause Python's garbage collector while a graph grows
8. `tasks`: work by threads, processes or a cluster
9. `limits`: a limit of time for code that others wrote
10. `deprecation`: names that are removed, and warn for one version before
11. `faces`: the names of a room, imported at their first use; where a name is that a room lacks
12. `records`: classes with named fields that print in one line, and are compared and pickled by their fields
13. `quantities`: checks of numbers that callers pass: their kind and their unit
"""
