"""What a motion is, where it comes from and which performance it holds, told by names and descriptions."""

from unicon.motion.catalogue.about import About, describe
from unicon.motion.catalogue.classes import classify
from unicon.motion.catalogue.cmu_index import CmuTake, cmu_index, cmu_take
from unicon.motion.catalogue.provenance import Provenance, provenance_of
from unicon.motion.catalogue.takes import take_of

__all__ = [
    "About",
    "CmuTake",
    "Provenance",
    "classify",
    "cmu_index",
    "cmu_take",
    "describe",
    "provenance_of",
    "take_of",
]
