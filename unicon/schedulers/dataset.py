"""The paper's dataset scheduler as a live source: clips of a library, one after the other.

What plays is one clip, a class of the tree, or all of the library. From more than one clip the motion
balancer draws (uniform descent of the class tree), so that rare classes are seen as often as common
ones. The clips are joined as the stitching scheduler joins them.
"""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from unicon import state
from unicon.errors import UniconError, UnknownNameError
from unicon.motion.catalogue.balancer import MotionBalancer
from unicon.motion.catalogue.class_tree import class_tree
from unicon.motion.clip import Clip, clip_from_poses
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library import ClipLibrary
from unicon.schedulers.stitching import Stitcher, StitcherConfig

MIN_SPEED, MAX_SPEED = 0.1, 4.0


@dataclass(frozen=True)
class DatasetConfig:
    """How clips are drawn, joined and sent."""

    seed: int = 0
    """Seed of the draws: the same seed and requests play the same clips."""
    stitcher: StitcherConfig = field(default_factory=StitcherConfig)


class Choice(NamedTuple):
    """What may play."""

    title: str
    """In words, e.g. class walking, 12 clips."""
    infos: tuple[ClipInfo, ...]


class DatasetScheduler:
    """Plays a library on an endless path; until told what, it stands."""

    def __init__(self, library: ClipLibrary, config: DatasetConfig, start_ns: int) -> None:
        self.stitcher = Stitcher(config.stitcher, start_ns, self._next_clip)
        """The path; ask it for the frames to send."""
        self._library = library
        self._random = np.random.default_rng(config.seed)
        self._choice: tuple[ClipInfo, ...] = ()
        self._balancer: MotionBalancer | None = None
        self._speed = 1.0
        self._loop = False

    def play(self, what: str, speed: float, loop: bool) -> Choice:
        """Play from now on: a clip, a class or, if empty, all of the library.

        With ``loop`` clip follows clip without end, otherwise one is played and then it stands.

        Raises:
            UnknownNameError: when there is no such clip or class; the message lists the nearest.
            UniconError: when the speed is out of range.
        """
        if not MIN_SPEED <= speed <= MAX_SPEED:
            raise UniconError(
                f"the speed is {speed:g}, expected {MIN_SPEED:g} to {MAX_SPEED:g} times that of the clip"
            )
        choice = choose(self._library.infos, what)
        self._balancer = MotionBalancer(choice.infos)
        self._choice, self._speed, self._loop = choice.infos, speed, loop
        self.stitcher.clear()
        return choice

    def stop(self) -> None:
        """Go over into standing."""
        self._choice = ()
        self.stitcher.clear()

    def _next_clip(self) -> Clip | None:
        if not self._choice or self._balancer is None:
            return None
        (drawn,) = self._balancer.sample(count=1, rng=self._random)
        clip = self._library.get(self._choice[drawn].name)
        if not self._loop:
            self._choice = ()
        return at_speed(clip, self._speed)


def choose(infos: Sequence[ClipInfo], what: str) -> Choice:
    """Return the clip of that name, else those of the class at that path, else (if empty) all.

    A slash at the end asks for the class where a clip has the same name. Of a class and of all, clips
    with marks are left out as far as others remain: flat ground without props does not suit them.

    Raises:
        UnknownNameError: when there is no such clip or class; the message lists the nearest.
    """
    named = tuple(info for info in infos if info.name == what)
    if named:
        return Choice(f"clip {what}, {named[0].seconds:.1f} s", named)
    nodes = {node.path: node for node in class_tree(infos).root.walk()}
    path = what.rstrip("/")
    if path not in nodes:
        raise UnknownNameError(_explain_unknown([info.name for info in infos], list(nodes), path))
    found = [infos[row] for row in nodes[path].rows()]
    suited = tuple(info for info in found if not info.marks) or tuple(found)
    title = f"class {path}" if path else "balanced random clips"
    return Choice(f"{title}, {len(suited)} to choose from", suited)


def _explain_unknown(clips: list[str], classes: list[str], what: str) -> str:
    classes = [f"{path}/" for path in classes if path]
    near = difflib.get_close_matches(what, clips + classes, n=5, cutoff=0.3) or classes[:5]
    return f"there is no clip and no class {what!r}; the nearest are {', '.join(near)}"


def at_speed(clip: Clip, speed: float) -> Clip:
    """Return the clip played ``speed`` times as fast, at 60 Hz: frame t shows its frame ``speed`` t."""
    if speed == 1.0:
        return clip
    last = len(clip) - 1
    places = np.minimum(np.arange(max(int(last / speed) + 1, 2)) * speed, last)
    left = np.minimum(places.astype(int), last - 1)
    poses = state.interpolate(clip.frames[left], clip.frames[left + 1], places - left)
    texts = {"source": clip.source, "licence": clip.licence, "label": clip.label}
    return clip_from_poses(clip.name, poses.root_pos_w, poses.root_quat_w, poses.joint_pos, **texts)
