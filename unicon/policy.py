"""What turns the avatar's state and its targets into a control: the reference servo or a trained network."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from unicon.control import Control, ServoControl, TorqueControl
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.observation import observe, policy_input
from unicon.policy_file import PolicyCard, PolicyWeights
from unicon.state import CharacterState

REFERENCE_SERVO = "reference_servo"


class PolicyContext(NamedTuple):
    """What a policy may look at: one avatar, or many with the batch shape (...)."""

    actual: CharacterState
    """The avatar's state at the beginning of the tick ``(...)``."""
    targets: CharacterState
    """The next targets ``(..., tau)``: one tick later, two ticks later, ..."""
    present: CharacterState | None = None
    """The target of the beginning of the tick ``(...)``; only baselines look at it."""
    past: CharacterState | None = None
    """The avatar's states one tick ago, two ticks ago ... ``(..., k)``; only baselines look at them."""


class Policy(Protocol):
    """Anything that can move the avatar."""

    @property
    def name(self) -> str:
        """Name shown wherever the policy is at work."""
        ...

    @property
    def trained(self) -> bool:
        """Whether it was trained."""
        ...

    @property
    def tau(self) -> int:
        """How many ticks ahead it has to know the targets; it need not look at all of them."""
        ...

    def act(self, context: PolicyContext) -> Control:
        """Return the control for the coming tick."""
        ...


class ReferenceServo:
    """The untrained reference: position servos at every joint, driven by the next target's hinge angles.

    It knows nothing of balance: it stands, and holds what is statically stable, but a walk makes it fall.
    """

    name = REFERENCE_SERVO
    trained = False
    tau = 1

    def act(self, context: PolicyContext) -> ServoControl:
        """Aim at the next target."""
        target = context.targets[..., 0, :]
        return ServoControl(target.joint_pos, target.joint_vel)


class NetworkPolicy:
    """A trained network: a multi-layer perceptron on the normalised s_t.

    Its outputs a are shares of the largest torques (effort). With q, dq the avatar's hinges and q*, dq*
    those of the nearest target frame that it looks at:

        torque        torque = effort a, held over the tick
        torque-servo  torque = effort a + stiffness (q* - q) + damping dq*, held over the tick
        pd            the same formula in every physics step, with a, q* and dq* held over the tick

    All are cut off at the effort factors. What it computes for an avatar does not depend on the others of
    a batch, to the bit.
    """

    trained = True

    def __init__(self, card: PolicyCard, weights: PolicyWeights) -> None:
        self.card = card
        self._weights = weights
        self._aim = min((ticks for ticks in card.frames_ahead if ticks > 0), default=1)

    @property
    def name(self) -> str:
        """The card's name."""
        return self.card.name

    @property
    def tau(self) -> int:
        """How many ticks ahead the last target frame lies that it looks at."""
        return max(1, *self.card.frames_ahead)

    @property
    def weights(self) -> PolicyWeights:
        """The network's numbers."""
        return self._weights

    @property
    def for_comparison_only(self) -> bool:
        """Whether it needs what the executor does not give: the present target or past states."""
        return 0 in self.card.frames_ahead or self.card.past > 0

    def act(self, context: PolicyContext) -> Control:
        """Run the network on s_t.

        Raises:
            UniconError: when it needs more than the context has.
        """
        offset = HUMANOID.effort * self._weights.evaluate(self.observe(context), self.card.activation)
        target = context.targets[..., self._aim - 1, :]
        if self.card.action == "pd":
            # stiffness (q* + offset / stiffness - q) = stiffness (q* - q) + offset
            return ServoControl(target.joint_pos + offset / HUMANOID.stiffness, target.joint_vel)
        torque = offset
        if self.card.action == "torque-servo":
            torque = torque + HUMANOID.stiffness * (target.joint_pos - context.actual.joint_pos)
            torque = torque + HUMANOID.damping * target.joint_vel
        return TorqueControl(np.clip(torque, -HUMANOID.effort, HUMANOID.effort))

    def observe(self, context: PolicyContext) -> np.ndarray:
        """Return the network's input ``(..., in)``: s_t, then o(X~) of past states, the latest first.

        Raises:
            UniconError: when it needs more than the context has.
        """
        seen = policy_input(context.actual, self._look_ahead(context))
        if not self.card.past:
            return seen
        if context.past is None:
            raise UniconError(f"the policy {self.name} looks at past states, which are not known here")
        past = context.past[..., : self.card.past, :]
        own = observe(past, forward_kinematics(past))
        return np.concatenate([seen, own.reshape(*own.shape[:-2], -1)], axis=-1)

    def _look_ahead(self, context: PolicyContext) -> CharacterState:
        """Return the target frames that it looks at ``(..., tau)``."""
        ahead = self.card.frames_ahead
        if ahead == tuple(range(1, len(ahead) + 1)):
            return context.targets[..., : len(ahead), :]
        if 0 not in ahead:
            return context.targets[..., [ticks - 1 for ticks in ahead], :]
        if context.present is None:
            raise UniconError(f"the policy {self.name} looks at the present target, which is not known here")
        present = vars(context.present[..., None, :])
        joined = {
            name: np.concatenate([present[name], value], axis=-2)
            for name, value in vars(context.targets).items()
        }
        return CharacterState(**joined)[..., list(ahead), :]
