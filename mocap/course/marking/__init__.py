"""Marks for notebooks handed in, whose code runs sealed: in a process, a folder and a home of its own.

The student's code and the check never meet in one process. The check, its random input and the right answers
are in the marker. The student's process gets the arguments of a call and gives back plain data: numbers,
text, arrays, lists, tuples, sets, dicts. So whatever a notebook changes, it changes for itself.

Reading order
-------------
1. `hand_ins`: the notebooks in folders and archives, and what is no notebook
2. `cells`: what the course asks for, and the cells of a notebook that an exercise needs
3. `notes`: what a notebook uses by which an answer could have been taken over, for the teacher
4. `plain_data`: answers as JSON, so that nothing in them can run
5. `student`: the student's side: run cells, call functions
6. `system_calls`: the system calls that this process may make
7. `call_filter`: a program for the kernel that refuses the others
8. `walls`: what the kernel keeps from that process
9. `bubblewrap`: a third wall, where that is installed
10. `keeper`: the start of that process, and the end of all that it started
11. `sealed`: the marker's side: start, ask, stop in time
12. `rosters`: who the students are
13. `likeness`: functions that are the published solution, or another student's
14. `grades`: points, tables for spreadsheets, Moodle and Canvas, the closing account, and feedback
15. `written_points`: the points that a person gave to answers in words
16. `class_page`: what the class misunderstood
17. `marks`: judge each exercise of each notebook
18. `container`: the whole command in a container, if that is asked for
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
