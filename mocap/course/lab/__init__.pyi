from . import own as own
from .adopting import mine as mine
from .adopting import whose as whose
from .asking import bet as bet
from .asking import bets as bets
from .asking import quiz as quiz
from .blind_tests import blind_test as blind_test
from .showing import inspector as inspector
