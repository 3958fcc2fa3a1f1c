"""Marks for notebooks handed in, whose code runs sealed: in a process, a folder and a home of its own.

The student's code and the check never meet in one process. The check, its random input and the right answers
are in the marker. The student's process gets the arguments of a call and gives back plain data: numbers,
text, arrays, lists, tuples, sets, dicts. So whatever a notebook changes, it changes for itself.

Reading order
-------------
1. `cells`: what the course asks for, and the cells of a notebook that an exercise needs
2. `plain_data`: answers as JSON, so that nothing in them can run
3. `student`: the student's side: run cells, call functions
4. `call_filter`: a program for the kernel that refuses system calls
5. `walls`: what the kernel keeps from that process
6. `keeper`: the start of that process, and the end of all that it started
7. `sealed`: the marker's side: start, ask, stop in time
8. `grades`: points, tables for spreadsheets, Moodle and Canvas, and a page for each student
9. `marks`: judge each exercise of each notebook
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
