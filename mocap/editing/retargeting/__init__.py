"""A motion made for one body, worn by another [Gle98].

The same angles on other bones slide, float and sink. So the turns are copied from body to body, then the
smooth change that is as small as possible brings the feet back to the floor, over all frames at once.

Reading order
-------------
1. `body_roles`: which joint does what
2. `upright_bodies`: how a body stands, as a value
3. `stances`: find it, whatever the rest pose is
4. `proportions`: a body with shorter legs or a larger head
5. `copied_motion`: every joint looks where the same joint of the other body looks
6. `floors`: where the new feet may be
7. `retargeted`: all of it in one function
"""
