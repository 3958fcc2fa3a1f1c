from . import asf as asf
from .load_save import load as load
from .load_save import read_angles as read_angles
from .load_save import save as save
from .load_save import save_clips as save_clips
from .path_files import load_path as load_path
from .plain_names import with_plain_names as with_plain_names
