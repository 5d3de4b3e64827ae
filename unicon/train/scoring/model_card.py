"""The model card: what a policy is, what it was trained on, and how good it is, for people."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from unicon.policy_file import PolicyCard, PolicyWeights

ACTIONS = {
    "torque": "torques, held over a tick",
    "torque-servo": "torques on top of a linear servo on the nearest target frame, held over a tick",
    "pd": "torques on top of a servo at the nearest target frame, computed in every physics step",
}
_ROWS = (
    ("survival", "share of a clip before a reward term falls under 0.1", "{:.3f}"),
    ("success", "mean body distance never over 0.5 m (S1)", "{:.1%}"),
    ("success_s3", "heights within 0.25 m, tilt within 0.8 (S3)", "{:.1%}"),
    ("reward", "reward, within 0..1", "{:.3f}"),
    ("root_relative_mm", "error relative to the root [mm]", "{:.1f}"),
    ("global_mm", "global error [mm]", "{:.1f}"),
    ("velocity_m_s", "velocity error [m/s]", "{:.3f}"),
    ("acceleration_m_s2", "acceleration error [m/s²]", "{:.2f}"),
    ("chatter", "share of the torques' power above 10 Hz", "{:.3f}"),
    ("skate_mm_per_frame", "slip of feet that carry weight [mm a frame]", "{:.2f}"),
)


def model_card(
    card: PolicyCard,
    weights: PolicyWeights,
    evaluation: dict[str, Any] | None,
    robustness: dict[str, Any] | None,
) -> str:
    """Return the card as Markdown; ``evaluation`` and ``robustness`` are the contents of the JSON files."""
    parts = [*_about(card, weights), *_scores(card, evaluation), *_robustness(card, robustness), *_limits()]
    return "\n".join(parts)


def _about(card: PolicyCard, weights: PolicyWeights) -> Iterator[str]:
    parameters = sum(weight.size + bias.size for weight, bias in weights.layers)
    ahead = ", ".join(f"{ticks}/60" for ticks in card.frames_ahead)
    past = f", and its own last {card.past} states" if card.past else ""
    yield from (f"# {card.name}", "", card.description, "", "| | |", "|---|---|")
    for name, value in (
        ("network", f"{'-'.join(map(str, weights.sizes))}, {card.activation}, {parameters:,} parameters"),
        ("sees", f"the avatar and its targets {ahead} s ahead{past}"),
        ("does", ACTIONS[card.action]),
        ("control", f"{card.control_hz} Hz, 240 Hz physics"),
        ("training", card.training or "not stated"),
        ("trained on", card.training_data),
        ("humanoid, observation", f"`{card.humanoid_id}`, `{card.observation_id}`"),
    ):
        yield f"| {name} | {value} |"
    yield ""


def _scores(card: PolicyCard, evaluation: dict[str, Any] | None) -> Iterator[str]:
    yield from ("## Scores", "")
    if evaluation is None:
        yield from ("Not evaluated yet: `unicon evaluate` writes them here.", "")
        return
    figures, clips = evaluation["all"], evaluation["all"]["clips"]
    yield from (f"On {evaluation['clips']}: {clips} clips, {evaluation['protocol']['run']}.", "")
    yield from (f"By `unicon evaluate policies/{card.name} --save`.", "", "| figure | |", "|---|---|")
    for name, words, form in _ROWS:
        yield f"| {words} | {_show(form, figures[name])} |"
    yield from ("", "| class | clips | survival | S1 | S3 | error mm |", "|---|---|---|---|---|---|")
    for path, values in evaluation["classes"].items():
        shown = [_show(form, values[name]) for name, form in (("survival", "{:.3f}"), ("success", "{:.0%}"))]
        shown += [_show("{:.0%}", values["success_s3"]), _show("{:.0f}", values["root_relative_mm"])]
        yield f"| {path} | {values['clips']} | {' | '.join(shown)} |"
    yield ""


def _robustness(card: PolicyCard, robustness: dict[str, Any] | None) -> Iterator[str]:
    if robustness is None:
        return
    yield from ("## Robustness", "", f"Reward relative to the unperturbed, on {robustness['clips']}.")
    yield from (f"By `unicon robustness policies/{card.name} --save`.", "", "| | relative |", "|---|---|")
    for trial in robustness["trials"]:
        yield f"| {trial['name']} | {_show('{:.1%}', trial['relative_reward'])} |"
    yield ""


def _limits() -> Iterator[str]:
    yield from (
        "## Limits",
        "",
        "Flat ground, no objects, no hands: motions that need more cannot be followed. It was trained in",
        "simulation for this humanoid alone and is not meant for machines.",
        "",
    )


def _show(form: str, value: float | None) -> str:
    return "-" if value is None else form.format(value)
