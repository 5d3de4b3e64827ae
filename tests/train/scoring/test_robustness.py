"""Tests for robustness.py."""

from __future__ import annotations

import json

import pytest
from rich.console import Console

from tests.samples import swaying_clip
from unicon.policy import ReferenceServo
from unicon.projectile import Barrage
from unicon.train.scoring.evaluation_clips import from_clips
from unicon.train.scoring.evaluation_runs import KinematicPolicy, Perturbation, ZeroPolicy
from unicon.train.scoring.robustness import (
    TRIALS,
    Trial,
    measure_robustness,
    robustness_as_json,
    robustness_table,
)

CLIPS = from_clips([swaying_clip(40, name="a"), swaying_clip(50, 0.3, name="b")])
BALLS = Trial("ball every 1", Perturbation(barrage=Barrage(1)))


def test_the_trials_are_the_papers():
    assert {t.perturbation.speed for t in TRIALS} == {0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6}
    assert {t.perturbation.mass for t in TRIALS} == {0.75, 1.0, 1.25}
    thrown = [t.perturbation.barrage.every_ticks for t in TRIALS if t.perturbation.barrage]
    assert (min(thrown), max(thrown)) == (1, 80)
    assert len({t.name for t in TRIALS}) == len(TRIALS) == 14


def test_rewards_are_relative_to_the_unperturbed():
    trials = (Trial("again", Perturbation()), Trial("light", Perturbation(mass=0.75)), BALLS)
    usual, again, light, balls = measure_robustness(ReferenceServo(), CLIPS, 1, trials)
    assert usual.relative_reward == again.relative_reward == 1.0
    reward = light.group.figures["reward"] / usual.group.figures["reward"]
    assert light.relative_reward == pytest.approx(reward) and reward != 1.0
    assert balls.relative_reward < 1.0


def test_the_target_itself_keeps_all_of_its_reward_at_every_speed():
    trials = [trial for trial in TRIALS if trial.name.startswith("speed")]
    outcomes = measure_robustness(KinematicPolicy(), CLIPS, 1, trials)
    assert [outcome.relative_reward for outcome in outcomes] == pytest.approx([1.0] * 7)
    assert outcomes[1].group.ticks > 2 * outcomes[0].group.ticks


def test_the_table_and_the_file_say_what_the_paper_does_not():
    outcomes = measure_robustness(ZeroPolicy(), CLIPS, 1, (BALLS,))
    console = Console(record=True, width=160)
    console.print(robustness_table("zero", "clips", outcomes))
    assert console.export_text().count("not stated") == 4
    values = json.loads(json.dumps(robustness_as_json("zero", "clips", outcomes)))
    assert values["projectiles"]["mass_kg"] == 0.5
    assert values["trials"][1]["name"] == "ball every 1"
    assert values["trials"][1]["paper"] is None
