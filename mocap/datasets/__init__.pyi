from .cmu_database import cmu as cmu
from .cmu_database import trials as trials
from .named_sets import from_set as from_set
from .samples import SAMPLES as SAMPLES
from .samples import sample as sample
