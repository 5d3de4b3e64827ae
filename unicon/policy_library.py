"""Finds a policy by name or folder and makes it ready to run."""

from __future__ import annotations

import difflib
import os
from pathlib import Path

from unicon.errors import UnknownNameError
from unicon.policy import REFERENCE_SERVO, NetworkPolicy, Policy, ReferenceServo
from unicon.policy_file import CARD_FILE, PolicyMismatchError, read_policy

POLICIES_VARIABLE = "UNICON_POLICIES"


def policies_folder() -> Path:
    """Return the folder of the policies: $UNICON_POLICIES, or ``policies/`` beside the library."""
    chosen = os.environ.get(POLICIES_VARIABLE)
    return Path(chosen) if chosen else Path(__file__).parents[1] / "policies"


def policy_names() -> list[str]:
    """Return the names of all policies, the reference servo first."""
    return [
        REFERENCE_SERVO,
        *sorted(card.parent.name for card in policies_folder().glob(f"*/{CARD_FILE}")),
    ]


def load_policy(name: str, comparing: bool = False) -> Policy:
    """Return a policy by its name, or by a folder that holds one.

    Args:
        name: of the policy, or its folder.
        comparing: take one that only an evaluation can run, too.

    Raises:
        UnknownNameError: when there is none; the message lists the nearest.
        InputFileError, PolicyMismatchError: when it cannot be used.
    """
    if name == REFERENCE_SERVO:
        return ReferenceServo()
    folder = Path(name) if os.sep in name else policies_folder() / name
    if not folder.is_dir() or not name:
        names = policy_names()
        near = difflib.get_close_matches(name, names, n=3, cutoff=0.3) or names
        raise UnknownNameError(f"there is no policy {name!r}; there are {', '.join(near)}")
    policy = NetworkPolicy(*read_policy(folder))
    if policy.for_comparison_only and not comparing:
        raise PolicyMismatchError(
            f"{folder}: looks at the present target or past states, which the executor does not give; it is "
            "for `unicon evaluate`"
        )
    return policy
