"""The exam of a teacher: forty questions, whose numbers a key draws, and the sheet to mark them with.

The package holds no answers. Those in numbers are computed from the numbers that the key draws, so that who
does not have the key knows neither. For functions, the key draws inputs that are built around a known result:
the package has no function that would solve them. Answers in words are the teacher's.

Reading order
-------------
1. `drawing`: a key, and the numbers that it draws
2. `wording`: numbers, vectors and tables as text
3. `poses_and_windows`: questions 1 to 9, and their answers in numbers
4. `graphs_and_walks`: questions 10 to 15, and their answers in numbers
5. `cases`: inputs with known results for questions 16 to 27
6. `sheets`: the sheet of questions, the sheet of answers, and the teacher's words in it
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
