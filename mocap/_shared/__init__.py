"""Small things that all rooms need; there is no need to read them first.

1. `arrays`: names for kinds of arrays; read-only copies, runs of True, joined ranges
2. `easing`: the curve that eases from 0 to 1
3. `atomic`: a file is written whole or not at all
4. `archives`: arrays in one file, unpacked only where it holds what it claims
5. `progress`: what functions take as `progress=`
6. `collector`: pause Python's garbage collector while a graph grows
7. `tasks`: work by threads, processes or a cluster
8. `limits`: a limit of time for code that others wrote
9. `deprecation`: names that are removed, and warn for one version before
"""
