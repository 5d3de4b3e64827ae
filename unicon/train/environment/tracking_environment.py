"""The tracking environment: avatars that follow clips, for the learner (``vector_environment.py``).

The avatar in frame f of its clip acts, the clip advances by a control step, and the reward compares the new
state with the new frame. Observation, reward and constraint are the library's; this module keeps account of
who is where, and says when an episode is over:

    terminated   a term is below its threshold, or the physics failed
    truncated    the clip has no room for another step, or the time is over
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.reward import RewardTerms, reward_terms, total_reward
from unicon.target_frames import unpack
from unicon.train.environment.action_modes import make_control, ticks_held
from unicon.train.environment.dataset import Dataset
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.episodes import EpisodeSampler
from unicon.train.environment.generator_state import generator_from_array, generator_to_array
from unicon.train.environment.observation_variants import parse_variant
from unicon.train.environment.reference_frames import ReferenceFrames
from unicon.train.environment.reset_states import add_noise, choose_frames
from unicon.train.environment.simulators import make_simulator
from unicon.train.environment.state_history import StateHistory
from unicon.train.environment.vector_environment import EnvironmentStep

__all__ = ["EnvironmentConfig", "TrackingEnvironment"]


class TrackingEnvironment:
    """N avatars that follow the clips of a data set; fulfils ``VectorEnvironment``."""

    def __init__(
        self,
        dataset: Dataset,
        config: EnvironmentConfig = EnvironmentConfig(),  # noqa: B008 - frozen
        rank: int = 0,
        say: Callable[[str], None] | None = None,
    ) -> None:
        """Make room; call ``reset`` before the first step.

        Args:
            dataset: the clips to follow.
            config: everything else.
            rank: of this process among several, so that each draws other starts.
            say: is given the sentence when another simulator has to stand in.

        Raises:
            UniconError: when a clip is too short.
        """
        self.config, self.dataset = config, dataset
        self.simulator = make_simulator(config, say)
        self.sampler = EpisodeSampler(dataset, config)
        self.variant = parse_variant(config.observation, config.stride)
        self._rng = np.random.default_rng([config.seed, rank])
        self._last_frames = dataset.lengths - 1
        self._episode_steps = max(1, round(config.episode_s * config.control_hz))
        self._open_frames()
        self.clips, self.frames, self.steps = np.zeros((3, config.num_envs), np.int64)
        self.mirrored = np.zeros(config.num_envs, np.bool_)
        self._history = StateHistory(config.num_envs, self.variant.past)
        self._total_steps = 0
        self._read()

    def _open_frames(self) -> None:
        """Lay down which frames are read at once: the present, what a servo aims at, what is seen."""
        config, variant = self.config, self.variant
        calls = config.frame_step // ticks_held(config.action, config.control_hz)
        aims = [variant.nearest + call for call in range(calls)]
        offsets = sorted({0, *aims, *variant.future})
        self._aims = [offsets.index(offset) for offset in aims]
        self._seen = [offsets.index(offset) for offset in variant.future]
        self._reference_frames = ReferenceFrames(self.dataset, offsets)
        self._single_frames = ReferenceFrames(self.dataset, (0,))

    @property
    def num_envs(self) -> int:
        """N."""
        return self.config.num_envs

    @property
    def observation_size(self) -> int:
        """Length of the policy's input."""
        return self.variant.size

    @property
    def action_size(self) -> int:
        """Numbers in an action."""
        return len(HUMANOID.joint_names)

    @property
    def target(self) -> np.ndarray:
        """The frames that the avatars should be in now, packed ``(N, 83)``."""
        return self._reference[:, 0]

    def reset(self) -> np.ndarray:
        """Begin a new episode everywhere; return the observations ``(N, O)``."""
        return self._begin(np.arange(self.num_envs))

    def step(self, actions: np.ndarray) -> EnvironmentStep:
        """Advance all by one control step under ``actions (N, 35)``; begin anew where an episode ends."""
        sound = self._move(np.asarray(actions, np.float32))
        terms = self._measure(sound)
        reward = total_reward(terms, self.config.reward)
        terminated = ~sound | self.breaks_constraint(terms)
        over = self.frames + self.config.frame_step > self._last_frames[self.clips]
        truncated = (over | (self.steps >= self._episode_steps)) & ~terminated
        self.sampler.add(self.clips, self.frames, terminated)
        observation = final = self._observe(sound)
        ended = np.flatnonzero(terminated | truncated)
        if len(ended):
            observation = final.copy()
            observation[ended] = self._begin(ended)
        return EnvironmentStep(observation, reward, terminated, truncated, final, terms)

    def state(self) -> dict[str, np.ndarray]:
        """Return all that determines what follows, random generator included, as named arrays."""
        parts = {"sampler": self.sampler.state(), "history": self._history.state()}
        return {
            "simulator": self.simulator.rows.copy(),
            "clips": self.clips.copy(),
            "frames": self.frames.copy(),
            "steps": self.steps.copy(),
            "mirrored": self.mirrored.copy(),
            "total_steps": np.array([self._total_steps]),
            "generator": generator_to_array(self._rng),
            **{f"{part}.{name}": array for part, arrays in parts.items() for name, array in arrays.items()},
        }

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Go back to a state, to the bit.

        Raises:
            ValueError: when it is of other numbers of environments or other clips.
            KeyError: when something is missing.
        """
        if state["clips"].shape != self.clips.shape:
            raise ValueError(f"it has {len(state['clips'])} environments, here are {self.num_envs}")
        self._rng = generator_from_array(state["generator"])
        self.sampler.restore(_part(state, "sampler"))
        self._history.restore(_part(state, "history"))
        for name in ("clips", "frames", "steps", "mirrored"):
            getattr(self, name)[:] = state[name]
        self._total_steps = int(state["total_steps"][0])
        self.simulator.restore(state["simulator"])
        self._read()

    def _read(self) -> None:
        """Read the frames around the present ones."""
        self._reference = self._reference_frames.read(self.clips, self.frames, self.mirrored)

    def _move(self, actions: np.ndarray) -> np.ndarray:
        """Advance physics and clips; return which avatars are sound ``(N,)``."""
        config, sound = self.config, np.ones(self.num_envs, np.bool_)
        if config.action != "kinematic":
            for aim in self._aims:
                actual, target = unpack(self.simulator.rows), unpack(self._reference[:, aim])
                control = make_control(config.action, actions, actual, target)
                sound &= self.simulator.step(control)
        self.frames += config.frame_step
        self.steps += 1
        self._total_steps += 1
        self._read()
        if config.action == "kinematic":
            self.simulator.put(self.target, np.arange(self.num_envs))
        return sound

    def _measure(self, sound: np.ndarray) -> RewardTerms:
        """Return the terms ``(N,)``, 0 where the physics failed."""
        terms = reward_terms(self.simulator.errors(self.target), self.config.reward)
        return RewardTerms(*(np.where(sound, term, np.float32(0.0)) for term in terms))

    def breaks_constraint(self, terms: RewardTerms) -> np.ndarray:
        """Return ``(N,)`` whether a term of each avatar is below the threshold that holds for it now."""
        if not self.config.constraint:
            return np.zeros(self.num_envs, np.bool_)
        thresholds = self.thresholds()[:, None]  # (5, 1)
        grace = self.steps <= round(self.config.grace_s * self.config.control_hz)
        lenient = np.minimum(thresholds, self.config.grace_threshold)
        kept = np.stack(terms) >= np.where(grace, lenient, thresholds)  # (5, N)
        return ~np.all(kept, axis=0)

    def thresholds(self) -> np.ndarray:
        """Return the terms' thresholds ``(5,)`` of an episode that is past its grace, as they are now."""
        config = self.config
        full = np.array(config.thresholds or (config.reward.threshold,) * 5)
        if self._total_steps >= config.loosening_steps:
            return full
        low = np.minimum(full, config.grace_threshold)
        return low + (full - low) * (self._total_steps / config.loosening_steps)

    def _observe(self, sound: np.ndarray) -> np.ndarray:
        """Return what all see ``(N, O)``; zeros where the physics failed."""
        seen = self._history.follow(self.simulator.observe(self._reference[:, self._seen]))
        if not sound.all():
            seen[~sound] = 0.0
        return seen

    def _begin(self, envs: np.ndarray) -> np.ndarray:
        """Begin new episodes in ``envs (n,)``; return what they see first ``(n, O)``."""
        starts = self.sampler.draw(len(envs), self._rng)
        self.clips[envs], self.frames[envs], self.mirrored[envs] = starts
        self.steps[envs] = 0
        self._reference[envs] = self._reference_frames.read(*starts)
        frames = choose_frames(starts.frames, self._last_frames[starts.clips], self.config, self._rng)
        rows = self._single_frames.read(starts.clips, frames, starts.mirrored)[:, 0]
        self.simulator.put(add_noise(rows, self.config, self._rng), envs)
        seen = self.simulator.observe(self._reference[envs][:, self._seen], envs)
        return self._history.begin(seen, envs)


def _part(state: Mapping[str, np.ndarray], name: str) -> dict[str, np.ndarray]:
    prefix = f"{name}."
    return {key.removeprefix(prefix): value for key, value in state.items() if key.startswith(prefix)}
