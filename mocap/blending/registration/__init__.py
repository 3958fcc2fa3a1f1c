"""Registration curves [KG03]: any number of clips on one clock, blended by any weights.

Reading order
-------------
1. `timewarps`: smooth curves over time whose slope stays within bounds
2. `contact_matches`: which plants of several clips are one and the same
3. `registering`: which frames of clips belong together, and how they lie on one another
4. `clocks`: where on the common clock each frame of a blend is
5. `mixing`: registered clips blended by weights, constant or moving
6. `crossfades`: from one clip into another, for as long as one likes
"""
