from .experiments import explore as explore
from .experiments import step_aside as step_aside
from .film import save_animation as save_animation
from .live_player import Mixer as Mixer
from .live_player import draw_path as draw_path
from .player import play as play
from .pointing import handles as handles
from .steered_widget import steered as steered
