"""Which map becomes which: any two shapes made into a morph that stays in one piece.

The paper asks for maps that correspond already, equal in number and orientation (Burch & Hart 1997, Section 6). Here
symmetries of the shapes, splits and doublings of their maps make them so, and a search finds the pairing.
"""

from .account import MatchReport
from .matcher import BUDGET, Match, match, match_steps
from .pairs import Pair, morph_of_pairs, pairs_from_plain, pairs_to_plain
from .wording import symmetry_text, word_text

__all__ = [
    "BUDGET",
    "Match",
    "MatchReport",
    "Pair",
    "match",
    "match_steps",
    "morph_of_pairs",
    "pairs_from_plain",
    "pairs_to_plain",
    "symmetry_text",
    "word_text",
]
