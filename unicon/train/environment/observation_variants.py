"""Which frames the policy sees, by the names of the paper's comparisons.

    tau-k          the next k target frames (1 to 8)
    lookahead-k    only the k-th target frame ahead
    stack-k        the next target frame, and the avatar's own last k states
    frames-a-b-c   those target frames, counted from the present as 0 (Chentanez 2018: frames-0-4-16-64)
    targets-only   the next target frame, and nothing of the avatar (Kinematic-State: open loop)
    phase-onehot   the avatar, how much of the clip is over, and a 1 at the clip's place (DeepMimic-Onehot)
    phase-number   the avatar, how much of the clip is over, and the clip's place as a number
                   (DeepMimic-Variable)

Frames are counted in strides. The input is s_t of ``unicon.observation.policy_input`` for the target frames,
then o(X~) of each past state, the latest first, as it was seen then; before the start of an episode its
first one stands for them. The last three are views of s_t for one target frame (observation_views.py).
"""

from __future__ import annotations

import re
from typing import Literal, NamedTuple

from unicon.errors import UniconError
from unicon.observation import MAX_TAU, OBSERVATION_SIZE, policy_input_size

View = Literal["whole", "targets-only", "phase-onehot", "phase-number"]
"""What the policy is given of s_t."""

_MAX_AHEAD = 240
_VIEWS: tuple[View, ...] = ("targets-only", "phase-onehot", "phase-number")


class ObservationVariant(NamedTuple):
    """What is seen besides the avatar's present state."""

    future: tuple[int, ...]
    """Target frames, counted from the present [1/60 s]."""
    past: int = 0
    """How many of the avatar's last states, one a control step."""
    view: View = "whole"
    """What the policy is given of that; other than "whole" only in baselines."""

    @property
    def size(self) -> int:
        """Length of s_t with the past states, of which the view is taken."""
        return policy_input_size(len(self.future)) + self.past * OBSERVATION_SIZE

    @property
    def nearest(self) -> int:
        """The nearest frame to come, at which a servo aims."""
        return min((offset for offset in self.future if offset > 0), default=1)


def parse_variant(name: str, stride: int) -> ObservationVariant:
    """Return the variant of a name, with ``stride`` frames between targets.

    Raises:
        UniconError: when there is no such variant.
    """
    kind, _, rest = name.partition("-")
    numbers = [int(text) for text in rest.split("-")] if re.fullmatch(r"\d{1,3}(-\d{1,3})*", rest) else []
    k = numbers[0] if len(numbers) == 1 else 0
    if stride < 1:
        raise UniconError(f"environment: the stride is {stride}, expected 1 or more")
    if kind == "tau" and 1 <= k <= MAX_TAU:
        return ObservationVariant(tuple(stride * i for i in range(1, k + 1)))
    if kind == "lookahead" and 1 <= k <= _MAX_AHEAD:
        return ObservationVariant((stride * k,))
    if kind == "stack" and 1 <= k <= MAX_TAU:
        return ObservationVariant((stride,), k)
    if kind == "frames" and 1 <= len(set(numbers)) == len(numbers) <= MAX_TAU and max(numbers) <= _MAX_AHEAD:
        return ObservationVariant(tuple(stride * i for i in numbers))
    for view in _VIEWS:
        if name == view:
            return ObservationVariant((stride,), view=view)
    raise UniconError(
        f"environment: there is no observation {name!r}; expected tau-1 to tau-{MAX_TAU}, lookahead-k, "
        f"stack-k, frames such as frames-0-4-16-64, {', '.join(_VIEWS)}"
    )
