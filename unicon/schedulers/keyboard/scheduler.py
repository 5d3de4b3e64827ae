"""The keyboard scheduler: commands in, target frames at 60 Hz out, as far ahead as is needed and no farther.

Frame k is due at ``start + k/60``. Frames are made one at a time just before they are sent: with a window of
two, a command shows in the second frame of the next message. A command that is not repeated is dropped after
``timeout_s``, and the character stops.

Nothing is fed back from the simulation unless asked for:

    feedback    the generator's place and heading are drawn to the avatar's by this share in every frame while
                it goes; while it stands only by what is farther than a leash
    wait_m      the commanded velocity falls from whole to nothing as the avatar lags from the first to the
                second of these distances
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from unicon import rotations, state
from unicon.motion.clip_index import RATE_HZ
from unicon.schedulers.keyboard.anchor import Anchor, anchor_between
from unicon.schedulers.keyboard.command import STAND, LocomotionCommand, clamp
from unicon.schedulers.keyboard.foot_lock import FootLock, FootLockConfig
from unicon.schedulers.keyboard.generator import GeneratorConfig, PoseGenerator, PoseNetwork
from unicon.schedulers.keyboard.go_to import Destination, GoTo, Progress
from unicon.schedulers.keyboard.path import HERE
from unicon.schedulers.pfnn.layout import GAITS
from unicon.schedulers.pfnn.network_card import PhaseNetworkCard
from unicon.schedulers.stitching import Window
from unicon.state import CharacterState
from unicon.target_frames import NS_PER_S

STANDING_LEASH_M = 0.3
"""With feedback, a reference that stands comes after an avatar that stands further off than this."""


@dataclass(frozen=True)
class KeyboardConfig:
    """How commands become frames."""

    window: int = 2
    """Frames in each window that is sent; a command shows so many frames later."""
    timeout_s: float = 0.5
    """A command holds for so long if it is not repeated."""
    feedback: float = 0.0
    """Share of the distance to the simulated avatar that is made up in every frame; 0: open loop."""
    wait_m: tuple[float, float] | None = None
    """Lags of the avatar at which the reference begins to slow down, and at which it stops; none: never."""
    generator: GeneratorConfig = field(default_factory=GeneratorConfig)
    """How poses are made."""
    foot_lock: FootLockConfig | None = None
    """How standing feet are held; none: they are as generated, as in the paper."""


class Lag(NamedTuple):
    """Where the simulated avatar is, seen from the frame that it should follow."""

    offset: np.ndarray
    """``(2,)`` [m], in the source's own frame."""
    turn: float
    """[rad]."""


class KeyboardScheduler:
    """A character steered by commands, as windows of frames by time."""

    def __init__(
        self, network: PoseNetwork, card: PhaseNetworkCard, config: KeyboardConfig, start_ns: int
    ) -> None:
        self.config, self.card = config, card
        self.generator = PoseGenerator(network, config.generator)
        self._start_ns = start_ns
        self._command, self._until_ns = STAND, start_ns
        standing = self.generator.state
        self._frames = [standing] * (config.window + 1)
        self._first = 0
        self._lag: Lag | None = None
        self._foot_lock = FootLock(config.foot_lock) if config.foot_lock else None
        self._go_to: GoTo | None = None
        self.progress: Progress | None = None
        """Of the way to a place, while there is one."""
        self.anchor = Anchor()
        """Where the frames lie in the world, as far as the executor said."""

    def command(self, command: LocomotionCommand, time_ns: int) -> tuple[str, ...]:
        """Take a command; return what of it was too much and was clamped, in words."""
        clamped = clamp(command, self.card)
        self._command, self._go_to = clamped.command, None
        self._until_ns = time_ns + round(self.config.timeout_s * NS_PER_S)
        return clamped.changes

    def follow(self, avatar: CharacterState, target: CharacterState, time_ns: int) -> None:
        """Take what the executor did: for going to places, for feedback and for waiting.

        Args:
            avatar: where the simulated avatar is in the world.
            target: where it should be, as the executor anchored this scheduler's frame.
            time_ns: which frame's time that is.
        """
        index = round((time_ns - self._start_ns) * RATE_HZ / NS_PER_S) - self._first
        frame = self._frames[int(np.clip(index, 0, len(self._frames) - 1))]
        self.anchor = anchor_between(frame, target)
        turn = rotations.heading_angle(avatar.root_quat_w) - rotations.heading_angle(target.root_quat_w)
        offset = self.anchor.to_source(avatar.root_pos_w[:2]) - self.anchor.to_source(target.root_pos_w[:2])
        self._lag = Lag(offset, float(np.remainder(turn + np.pi, 2.0 * np.pi) - np.pi))

    def go_to(self, destination: Destination) -> None:
        """Walk to a place in the world from now on; any command ends it."""
        pos_w = self.anchor.to_world(self.generator.state.root_pos_w[:2])
        self._go_to = GoTo(destination, pos_w)
        self.progress = None

    @property
    def going(self) -> bool:
        """Whether it is on its way to a place."""
        return self._go_to is not None

    def stop(self) -> None:
        """Stand still, and go nowhere."""
        self._go_to, self._command = None, STAND

    def place(self, pos_w: np.ndarray, heading: float) -> None:
        """Go on from another place and heading on the ground: frames not sent yet begin there."""
        turn = heading - self.generator.heading
        before = self.generator.state.root_pos_w
        self.generator.place(pos_w, heading)
        moved = [state.move(frame, np.array(0.0), -_flat(before)) for frame in self._frames]
        self._frames = [state.move(frame, np.array(turn), _flat(np.asarray(pos_w))) for frame in moved]
        self._lag = None
        if self._foot_lock:
            self._foot_lock.reset()

    def next_frames(self, time_ns: int) -> Window:
        """Return the window of frames that begins one frame after ``time_ns``."""
        index = round((time_ns - self._start_ns) * RATE_HZ / NS_PER_S) + 1
        index = max(index, self._first)
        while self._first + len(self._frames) < index + self.config.window:
            due_ns = self._start_ns + round((self._first + len(self._frames)) * NS_PER_S / RATE_HZ)
            self._frames.append(self._make(due_ns))
        # one frame of the past is kept for the avatar's state that comes late
        kept = max(index - 1 - self._first, 0)
        self._frames, self._first = self._frames[kept:], self._first + kept
        first = index - self._first
        frames = state.stack(self._frames[first : first + self.config.window])
        return Window(self._start_ns + round(index * NS_PER_S / RATE_HZ), frames)

    @property
    def playing(self) -> str:
        """The gait that it goes in."""
        return GAITS[int(self.generator.path.gait[HERE].argmax())]

    def _make(self, due_ns: int) -> CharacterState:
        """Make a frame, by the command that holds then."""
        command = self._command if due_ns <= self._until_ns + NS_PER_S / RATE_HZ else STAND
        if self._go_to is not None:
            command = self._steer(self._go_to)
        if self._lag is not None:
            command = self._waited(command, float(np.linalg.norm(self._lag.offset)))
            self._draw_to_avatar(self._lag)
        frame = self.generator.step(command)
        return self._foot_lock.lock(frame, self.generator.contacts) if self._foot_lock else frame

    def _steer(self, go_to: GoTo) -> LocomotionCommand:
        """Steer in the world: the anchor may change on the way."""
        generator, anchor = self.generator, self.anchor
        pos_w = anchor.to_world(generator.state.root_pos_w[:2])
        self.progress = go_to.steer(pos_w, generator.heading + anchor.turn)
        if self.progress.state != "going":
            self.stop()
        command = self.progress.command
        if command.facing_w is not None:
            command = replace(command, facing_w=command.facing_w - anchor.turn)
        return clamp(command, self.card).command

    def _waited(self, command: LocomotionCommand, lag_m: float) -> LocomotionCommand:
        if self.config.wait_m is None:
            return command
        share = float(np.interp(lag_m, self.config.wait_m, (1.0, 0.0)))
        x, y = command.velocity_h
        return replace(command, velocity_h=(share * x, share * y))

    def _draw_to_avatar(self, lag: Lag) -> None:
        generator, standing = self.generator, self.generator.path.standing
        # a reference that stands and still goes along with an avatar that leans would let it lean and fall
        going = self.config.feedback * (1.0 - standing)
        length = max(float(np.linalg.norm(lag.offset)), STANDING_LEASH_M)
        share = going + self.config.feedback * standing * (1.0 - STANDING_LEASH_M / length)
        if share <= 0.0:
            return
        before = generator.state.root_pos_w[:2].copy()
        after = before + share * lag.offset
        generator.place(after, generator.heading + going * lag.turn)
        if self._foot_lock:
            self._foot_lock.move(going * lag.turn, before, after)
        self._lag = Lag((1.0 - share) * lag.offset, (1.0 - going) * lag.turn)


def _flat(pos_w: np.ndarray) -> np.ndarray:
    return np.array([pos_w[0], pos_w[1], 0.0])
