"""The model card of a phase-functioned network, for people."""

from __future__ import annotations

import math
from collections.abc import Iterator

from unicon.schedulers.pfnn.network_card import PhaseNetworkCard

_UNITS = {
    "root_vel_h": ("root velocity along the ground", "m/s", 1.0),
    "turn_rate": ("turn rate", "rad/s", 1.0),
    "phase_rate": ("phase rate", "rad/s", 1.0),
    "contacts": ("contacts of heels and toes", "0 to 1", 1.0),
    "path_pos_h": ("places along the path ahead", "m", 1.0),
    "path_facing_h": ("facing along the path ahead", "unit vector", 1.0),
    "root_height": ("height of the root", "mm", 1e3),
    "root_rot6d_h": ("tilt of the root", "rotation matrix", 1.0),
    "joint_pos": ("hinge angles", "degrees", math.degrees(1.0)),
    "joint_vel": ("hinge velocities", "degrees/s", math.degrees(1.0)),
}
_LIMITS = {
    "forward_m_s": "forward [m/s]",
    "backward_m_s": "backward [m/s]",
    "sideways_m_s": "sideways [m/s]",
    "turn_rad_s": "turning [rad/s]",
}


def model_card(card: PhaseNetworkCard) -> str:
    """Return the card as Markdown."""
    return "\n".join([*_about(card), *_limits(card), *_errors(card), *_data(card), *_cautions()]) + "\n"


def _about(card: PhaseNetworkCard) -> Iterator[str]:
    numbers = card.phases * sum((a + 1) * b for a, b in zip(card.sizes, card.sizes[1:], strict=False))
    yield from (f"# {card.name}", "", card.description, "", "| | |", "|---|---|")
    for name, value in (
        ("network", f"{'-'.join(map(str, card.sizes))}, elu, {numbers:,} numbers"),
        ("phase function", f"{card.interpolation} through weights at {card.phases} phases"),
        ("gaits", ", ".join(card.gaits)),
        ("training", card.training),
        ("seed, commit", f"{card.seed}, `{card.commit or 'unknown'}`"),
        ("humanoid, layout", f"`{card.humanoid_id}`, `{card.layout_id}`"),
    ):
        yield f"| {name} | {value} |"
    yield ""


def _limits(card: PhaseNetworkCard) -> Iterator[str]:
    yield from ("## Speeds", "", "What it was trained on, and no faster:", "", "| | |", "|---|---|")
    for name, value in card.limits.items():
        yield f"| {_LIMITS.get(name, name)} | {value:.2f} |"
    yield from ("", "| gait | slow | usual | fast [m/s] |", "|---|---|---|---|")
    for gait, speeds in card.gait_speeds_m_s.items():
        yield f"| {gait} | {' | '.join(f'{speed:.2f}' for speed in speeds)} |"
    yield ""


def _errors(card: PhaseNetworkCard) -> Iterator[str]:
    takes = len(card.held_out_takes)
    where = f"{takes} takes that it has never seen" if takes else "the takes that it was trained on"
    yield from ("## Error", "", f"Of the next frame, root mean square, on {where}.", "")
    yield from ("| part of the output | error | unit |", "|---|---|---|")
    for name, value in card.held_out_error.items():
        words, unit, scale = _UNITS.get(name, (name, "normalised mean square", 1.0))
        yield f"| {words} | {value * scale:.4g} | {unit} |"
    yield from ("", "![Curves of the training](training.png)", "")


def _data(card: PhaseNetworkCard) -> Iterator[str]:
    yield from ("## Trained on", "", *(f"- {line}" for line in card.training_data), "")
    yield from (
        f"{len(card.takes)} takes; their names are in pfnn.json, and what they show in [data.md](data.md).",
        "",
    )


def _cautions() -> Iterator[str]:
    yield from (
        "## Limits",
        "",
        "Flat ground alone: it knows no stairs, no slopes and no obstacles. Feet may slide a little where",
        "the foot lock is off. It is for this humanoid's proportions.",
    )
