"""Small things that all rooms need; there is no need to read them first.

 1. `arrays`: types of arrays; read-only copies, runs of True, concatenated ranges
 2. `ties`: values that differ only by rounding are equal, and the first of equals is taken
 3. `easing`: the curve that eases from 0 to 1
 4. `atomic`: a file is written whole or not at all
 5. `archives`: arrays in one file, unpacked only if it holds what it claims; kinds of such files
 6. `progress`: the type of the parameter `progress=`
 7. `collector`: pause Python's garbage collector while a graph grows
 8. `tasks`: work by threads, processes or a cluster
 9. `limits`: a time limit for code that others wrote
10. `deadlines`: a moment at which a search ends with the best that it has
11. `deprecation`: names that are removed, and warn for one version before
12. `faces`: the names of a room, imported at their first use; the room of a name that a room lacks
13. `records`: classes with named fields that print in one line, and are compared and pickled by their fields
14. `quantities`: checks of numbers that callers pass: their kind and their unit
15. `arguments`: checks of the arguments of a call, including those that are missing
16. `suggestions`: the error for an attribute that is missing, with what may be meant
"""
