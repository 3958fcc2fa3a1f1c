from .drawing import read_key as read_key
from .sheets import write_exam as write_exam
