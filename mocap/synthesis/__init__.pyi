from .bounded_search import Problem as Problem
from .bounded_search import SearchResult as SearchResult
from .bounded_search import branch_and_bound as branch_and_bound
from .bounded_search import search_ahead as search_ahead
from .random_walks import random_walk as random_walk
from .walk_to_motion import seams as seams
from .walk_to_motion import sources as sources
from .walk_to_motion import to_motion as to_motion
