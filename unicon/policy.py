"""What turns the avatar's state and its targets into a control: the reference servo or a trained network."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from unicon.control import Control, ServoControl, TorqueControl
from unicon.humanoid import HUMANOID
from unicon.observation import policy_input
from unicon.policy_file import PolicyCard, PolicyWeights
from unicon.state import CharacterState

REFERENCE_SERVO = "reference_servo"


class PolicyContext(NamedTuple):
    """What a policy may look at."""

    actual: CharacterState
    """The avatar's state at the beginning of the tick."""
    targets: CharacterState
    """The next targets, batch ``(tau,)``: one tick later, two ticks later, ..."""


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
        """How many target frames it looks at, 1 to 8."""
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
        target = context.targets[0]
        return ServoControl(target.joint_pos, target.joint_vel)


class NetworkPolicy:
    """A trained network: torque = effort * (network(s_t) + servo prior), held over the tick.

    The network is a multi-layer perceptron on the normalised s_t. With the action "torque-servo" a fixed
    servo on the first target, linear in s_t, is added: stiffness (q_1 - q) + damping dq_1.
    """

    trained = True

    def __init__(self, card: PolicyCard, weights: PolicyWeights) -> None:
        self.card = card
        self._weights = weights

    @property
    def name(self) -> str:
        """The card's name."""
        return self.card.name

    @property
    def tau(self) -> int:
        """The card's number of target frames."""
        return self.card.tau

    def act(self, context: PolicyContext) -> TorqueControl:
        """Run the network on s_t."""
        seen = policy_input(context.actual, context.targets)
        torque = HUMANOID.effort * self._weights.evaluate(seen, self.card.activation)
        if self.card.action == "torque-servo":
            target = context.targets[0]
            torque = torque + HUMANOID.stiffness * (target.joint_pos - context.actual.joint_pos)
            torque = torque + HUMANOID.damping * target.joint_vel
        return TorqueControl(np.clip(torque, -HUMANOID.effort, HUMANOID.effort))
