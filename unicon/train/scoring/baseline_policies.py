"""Scores a trained network whatever it sees, the baselines that the executor cannot run among them.

The environment's views of s_t (``environment/observation_views.py``) are shown to the network in the
evaluation, too. A network that knows its clips by their place can follow no others.
"""

from __future__ import annotations

import numpy as np

from unicon.policy import NetworkPolicy, PolicyContext
from unicon.policy_file import PolicyCard, PolicyWeights
from unicon.train.environment.dataset import Dataset
from unicon.train.environment.observation_variants import View, parse_variant
from unicon.train.environment.observation_views import target_of, with_clip
from unicon.train.runs.recipe import Recipe
from unicon.train.runs.trained_policy import card_of
from unicon.train.scoring.evaluation import Evaluation, evaluate
from unicon.train.scoring.evaluation_clips import ClipSource
from unicon.train.scoring.evaluation_runs import run_clips


class OpenLoopPolicy(NetworkPolicy):
    """Sees the next target frame and nothing of the avatar."""

    def observe(self, context: PolicyContext) -> np.ndarray:
        """Return o(X) of the target ``(..., 197)``."""
        return target_of(super().observe(context))


class ClipPolicy(NetworkPolicy):
    """Knows which clip it follows, and counts its ticks from the first one on."""

    def __init__(
        self, card: PolicyCard, weights: PolicyWeights, view: View, clip: int, lengths: np.ndarray
    ) -> None:
        """Begin with a clip.

        Args:
            card: of s_t for one target frame.
            weights: the network's numbers.
            view: "phase-onehot" or "phase-number".
            clip: its place in the data set that was learned.
            lengths: frames of the clips of that data set ``(C,)``.
        """
        super().__init__(card, weights)
        self._view: View = view
        self._clip, self._count, self._last_frame = clip, len(lengths), int(lengths[clip]) - 1
        self._tick = 0

    def observe(self, context: PolicyContext) -> np.ndarray:
        """Return o(X~), phase and clip ``(N, ...)``; the next call is a tick later."""
        seen = super().observe(context)
        clips, phases = np.full(len(seen), self._clip), np.full(len(seen), self._tick / self._last_frame)
        self._tick += 1
        return with_clip(seen, self._view, clips, self._count, phases)


def score_network(
    recipe: Recipe, weights: PolicyWeights, learned: Dataset, source: ClipSource, name: str, jobs: int
) -> Evaluation | None:
    """Score a network in MuJoCo as `unicon evaluate` does; None where it cannot follow such clips.

    Args:
        recipe: what trained it.
        weights: the network's numbers.
        learned: the clips of the training.
        source: the clips to score it on.
        name: of the policy.
        jobs: processes; 0: one a core.

    Raises:
        UniconError: when a process was killed, or the recipe trains no policy.
    """
    card = card_of(recipe, name)
    view = parse_variant(recipe.environment.observation, recipe.environment.stride).view
    if view == "whole":
        return evaluate(NetworkPolicy(card, weights), source, jobs=jobs)
    if view == "targets-only":
        return evaluate(OpenLoopPolicy(card, weights), source, jobs=jobs)
    places = {info.name: place for place, info in enumerate(learned.infos)}
    if not all(info.name in places for info in source.infos):
        return None
    scores = []
    for info, clip in zip(source.infos, source.load(), strict=True):
        policy = ClipPolicy(card, weights, view, places[info.name], learned.lengths)
        scores.append(run_clips(policy, [clip])[0].score())
    return Evaluation(name, source.title, source.infos, tuple(scores), source.frames_file)
