"""A motion made for one body, worn by another [Gle98].

The same angles on other bones slide, float and sink. So the turns are copied from body to body, then the
smooth change that is as small as possible brings the feet back to the floor, over all frames at once.

Reading order
-------------
1. `body_roles`: which joint does what
2. `stances`: how a body stands, whatever its rest pose is
3. `proportions`: a body with shorter legs or a larger head
4. `copied_motion`: every joint looks where the same joint of the other body looks
5. `floors`: where the new feet may be
6. `retargeted`: all of it in one function
"""
