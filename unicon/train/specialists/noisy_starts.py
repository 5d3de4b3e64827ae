"""Whether a policy masters clips with a margin: runs from noisy starts, at 30 and at 60 Hz.

A single run from a clip's very first frame may succeed by a hair, and fails in MuJoCo then. So every clip is
run several times, each from a state with the training's noise; long clips in pieces of 10 s. A run is the
longer survived the later a term falls below its threshold, and succeeds if it survives and

    |root off| + (mean over joints of |off against the root|^2)^(1/2) <= 0.5 m

all along, read from the terms. As the mean distance of the bodies is not above the left side, but for a turn
of the heading, this is stricter than the success of an evaluation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import torch

from unicon.motion.clip_index import RATE_HZ
from unicon.reward import RewardConfig, RewardTerms
from unicon.train.environment.dataset import Dataset
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.episodes import EpisodeSampler, Starts
from unicon.train.environment.tracking_environment import TrackingEnvironment
from unicon.train.learning.networks import ActorCritic
from unicon.train.specialists.plan import ClipResult

PIECE_S = 10.0
_RATES_HZ = (30, 60)
_FAR_M = 0.5
_LEAST_TERM = 1e-12


class NoisyStarts:
    """Runs of all clips of a data set; made once, it may be asked often."""

    def __init__(self, dataset: Dataset, config: EnvironmentConfig, repeats: int) -> None:
        """Make room.

        Args:
            dataset: the clips.
            config: that of the training; its noises of a start are used.
            repeats: runs of each piece of a clip, at each rate.
        """
        self._dataset = dataset
        clips, frames = _pieces(dataset.lengths)
        self._clips = np.repeat(clips, repeats)
        starts = Starts(self._clips, np.repeat(frames, repeats), np.zeros(len(self._clips), np.bool_))
        self._environments = [_environment(dataset, config, rate, starts) for rate in _RATES_HZ]
        self._beginnings = [environment.state() for environment in self._environments]

    def measure(self, network: ActorCritic) -> tuple[ClipResult, ...]:
        """Return how a policy, without noise on its actions, follows each clip.

        The starts are the same each time.
        """
        runs = []
        for environment, beginning in zip(self._environments, self._beginnings, strict=True):
            environment.restore(beginning)
            runs.append(_run(environment, network))
        survival = self._mean([survived for survived, _ in runs])
        success = self._mean([succeeded for _, succeeded in runs])
        names = [info.name for info in self._dataset.infos]
        return tuple(map(ClipResult, names, survival.tolist(), success.tolist()))

    def _mean(self, runs: Sequence[np.ndarray]) -> np.ndarray:
        """Return the mean ``(C,)`` of each clip's runs."""
        sums = sum(np.bincount(self._clips, run, len(self._dataset.rows)) for run in runs)
        return sums / (len(runs) * np.bincount(self._clips, minlength=len(self._dataset.rows)))


def far_off(terms: RewardTerms, config: RewardConfig) -> np.ndarray:
    """Return where bodies may be more than 0.5 m off on average ``(N,)``: e_i = -ln(r_i) / k_i."""
    root, joints = (
        np.sqrt(-np.log(np.maximum(terms[index], _LEAST_TERM)) / config.exponents[index]) for index in (0, 2)
    )
    return root + joints > _FAR_M


def _pieces(lengths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return clips and first frames of pieces of the same length, up to 10 s, that cover all clips."""
    counts = np.maximum(1, np.ceil((lengths - 1) / (PIECE_S * RATE_HZ))).astype(np.int64)
    clips = np.repeat(np.arange(len(lengths)), counts)
    place = np.arange(len(clips)) - np.repeat(np.cumsum(counts) - counts, counts)
    return clips, place * (lengths - 1)[clips] // counts[clips]


class _GivenStarts(EpisodeSampler):
    """Begins where it is told to."""

    def __init__(self, dataset: Dataset, config: EnvironmentConfig, starts: Starts) -> None:
        super().__init__(dataset, config)
        self._starts = starts

    def draw(self, count: int, rng: np.random.Generator) -> Starts:
        """Return the first of the starts; at a reset, all."""
        return Starts(*(values[:count] for values in self._starts))


def _environment(
    dataset: Dataset, config: EnvironmentConfig, rate_hz: int, starts: Starts
) -> TrackingEnvironment:
    config = replace(
        config,
        num_envs=len(starts.clips),
        control_hz=rate_hz,  # type: ignore[arg-type]
        episode_s=PIECE_S,
        constraint=True,
        loosening_steps=0,
        rsis_share=0.0,
        mirror_share=0.0,
    )
    environment = TrackingEnvironment(dataset, config)
    environment.sampler = _GivenStarts(dataset, config, starts)
    return environment


@torch.no_grad()
def _run(environment: TrackingEnvironment, network: ActorCritic) -> tuple[np.ndarray, np.ndarray]:
    """Return of each run the share that is survived, and whether it succeeded ``(N,)``."""
    device = network.log_std.device
    seen = environment.reset()
    going = np.ones(environment.num_envs, np.bool_)
    strayed = np.zeros_like(going)
    broken = np.zeros_like(going)
    steps = np.zeros(environment.num_envs)
    left = environment.dataset.lengths[environment.clips] - 1 - environment.frames
    possible = np.minimum(left // environment.config.frame_step, PIECE_S * environment.config.control_hz)
    while going.any():
        actions = network.act(torch.from_numpy(np.ascontiguousarray(seen)).to(device))
        step = environment.step(actions.cpu().numpy())
        strayed |= going & far_off(step.terms, environment.config.reward)
        broken |= going & step.terminated
        steps += going & ~step.terminated
        going &= ~(step.terminated | step.truncated)
        seen = step.observation
    return np.where(broken, steps / possible, 1.0), (~broken & ~strayed).astype(np.float64)
