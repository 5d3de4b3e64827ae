"""The motion balancer: which clip to train on next, evenly over the class tree (UniCon, motion balancer).

A data set of ten thousand walks and three cartwheels would teach walking alone. So a clip is drawn by
descending the tree: every child of a node is as likely as its siblings, down to the clips of a leaf.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from unicon.errors import UniconError
from unicon.motion.catalogue.class_tree import ClassNode, class_tree
from unicon.motion.clip_index import ClipInfo


class MotionBalancer:
    """Draws clips; made once for a list of rows.

    Raises:
        UniconError: when there is nothing to draw from.
    """

    def __init__(self, rows: Sequence[ClipInfo]) -> None:
        if not rows:
            raise UniconError("there are no clips to draw from; import some or choose another sub-dataset")
        self.probabilities = descend(class_tree(rows).root, len(rows))
        """Probability of each row ``(C,)``; sums to 1."""
        self.probabilities.flags.writeable = False
        self._cumulative = np.cumsum(self.probabilities)
        self._cumulative /= self._cumulative[-1]

    def sample(self, count: int, rng: np.random.Generator) -> np.ndarray:
        """Return the row of each of ``count`` draws ``(count,)``, with repetition."""
        return np.searchsorted(self._cumulative, rng.random(count), side="right")


def descend(root: ClassNode, count: int) -> np.ndarray:
    """Return the probability ``(count,)`` of each row by uniform descent from ``root``.

    A node shares its probability evenly among its children. Where clips carry the label of a node that
    has children too, they count together as one child more. The last share is even among clips:
    p(clip) = product over its ancestors of 1 / (number of children), times 1 / (clips beside it).
    """
    probabilities = np.zeros(count)
    waiting = [(root, 1.0)]
    while waiting:
        node, share = waiting.pop()
        part = share / (len(node.children) + bool(node.own))
        probabilities[list(node.own)] = part / max(len(node.own), 1)
        waiting += [(child, part) for child in node.children]
    return probabilities
