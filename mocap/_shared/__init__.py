"""Utilities that all rooms use. There is no need to read them first.

 1. `arrays`: types of arrays, read-only copies, runs of True, concatenated ranges
 2. `ties`: comparison with a tolerance, with ties broken by order
 3. `easing`: a smooth step from 0 to 1
 4. `atomic`: atomic writing of files
 5. `archives`: `.npz` files, checked before they are unpacked, and kinds of such files
 6. `progress`: the type of the parameter `progress=`
 7. `collector`: a pause of Python's garbage collector while a graph is built
 8. `tasks`: execution by threads, processes or a cluster
 9. `limits`: a time limit for untrusted code
10. `deadlines`: deadlines of searches
11. `deprecation`: deprecated names, which warn for one version before they are removed
12. `renamed`: new names of what earlier versions called by other ones
13. `faces`: lazy imports of the names of a room, and suggestions for unknown names
14. `records`: classes with named fields: printed in one line, compared and pickled by their fields
15. `quantities`: checks of the type and the unit of numbers
16. `arguments`: checks of the arguments of a call, including missing ones
17. `suggestions`: the error for an unknown attribute, with a suggestion
"""
