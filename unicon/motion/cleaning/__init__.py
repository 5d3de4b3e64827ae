"""Cleaning of source motions: defects are found, mended or cut, and each decision is told with its reason."""

from unicon.motion.cleaning.clean import clean
from unicon.motion.cleaning.decisions import MARKS, REASONS, Cleaning, Decision, Hints
from unicon.motion.cleaning.overrides import Order, Overrides, load_overrides, shipped_overrides

__all__ = [
    "MARKS",
    "REASONS",
    "Cleaning",
    "Decision",
    "Hints",
    "Order",
    "Overrides",
    "clean",
    "load_overrides",
    "shipped_overrides",
]
