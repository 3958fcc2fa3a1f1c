from .load_save import load as load
from .load_save import read_angles as read_angles
from .load_save import save as save
