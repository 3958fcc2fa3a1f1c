"""glTF 2.0, binary (`.glb`): a skeleton, its motion, and a body of capsules around it.

A `.glb` holds a JSON text that says what is there, and one block of numbers. Both are written with NumPy and
`json` alone [GLTF21]. glTF is in metres with y up, as this package is, so nothing is converted.

1. `binary`: the container, and the arrays in it
2. `capsules`: a body for a viewer to show, rigid pieces around the bones
3. `document`: joints, skin and animation, and the file

References
----------
.. [GLTF21] Khronos Group, *glTF 2.0 Specification*, version 2.0.1, 2021.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submod_attrs={"document": ["write"]})
