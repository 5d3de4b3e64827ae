"""Tests for evaluation_runs.py: the executor's run to the bit, independence of the batch, perturbations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.samples import START_NS, TICK_NS, message, swaying_clip
from tests.train.policy_samples import make_policy
from unicon.commands import Reset
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.policy import ReferenceServo
from unicon.projectile import Barrage
from unicon.simulation import Simulation
from unicon.target_frames import pack
from unicon.tracking import Tracker, TrackerConfig
from unicon.train.scoring.evaluation_runs import (
    KinematicPolicy,
    Perturbation,
    ZeroPolicy,
    find_policy,
    run_clips,
    scale_mass,
)

CLIPS = [swaying_clip(50, name="a"), swaying_clip(80, 0.4, name="b"), swaying_clip(35, 0.2, name="c")]
POLICIES = [
    ReferenceServo(),
    make_policy(),
    make_policy(action="torque-servo", tau=3, scale=0.1),
    make_policy(action="pd", tau=2, future=(2, 4), activation="silu", hidden=(300, 200)),
]


def run_in_lockstep(policy, clip) -> tuple[np.ndarray, np.ndarray]:
    """Let the executor follow a clip from its first frame; return states and targets, packed."""
    tracker = Tracker(TrackerConfig(reset_after_s=-1.0))
    tracker.policy = policy
    tracker.simulation.reset(clip.frames[0])

    def tick(k: int):
        frames = [clip.frames[i] for i in range(k + 1, min(k + 10, len(clip)))]
        if frames:
            assert (
                tracker.offer(message(k + 1, START_NS + (k + 1) * TICK_NS, *frames, interval_s=TICK_NS / 1e9))
                is None
            )
        return tracker.tick(START_NS + k * TICK_NS)

    tick(-1)  # the source is anchored where the avatar stands: at the clip's own first frame
    assert tracker.apply(Reset("target")).success
    reports = [tick(k) for k in range(len(clip) - 1)]
    return (
        np.stack([pack(report.actual) for report in reports]),
        np.stack([pack(report.target) for report in reports]),
    )


@pytest.mark.parametrize("policy", POLICIES, ids=["servo", "torque", "torque-servo", "pd"])
def test_a_run_equals_the_executors_in_lockstep_to_the_bit(policy):
    runs = run_clips(policy, CLIPS, stop_when_lost=False)
    for clip, run in zip(CLIPS, runs, strict=True):
        states, targets = run_in_lockstep(policy, clip)
        assert np.array_equal(pack(run.target), targets)
        assert np.array_equal(pack(run.actual), states)


@pytest.mark.parametrize("policy", POLICIES[1:], ids=["torque", "torque-servo", "pd"])
def test_what_happens_in_a_clip_does_not_depend_on_the_others(policy):
    together = run_clips(policy, CLIPS)
    alone = [run_clips(policy, [clip])[0] for clip in reversed(CLIPS)][::-1]
    for one, other in zip(together, alone, strict=True):
        assert np.array_equal(pack(one.actual), pack(other.actual))
        assert np.array_equal(one.torque, other.torque)


def test_the_target_itself_is_followed_perfectly():
    for clip, run in zip(CLIPS, run_clips(KinematicPolicy(), CLIPS), strict=True):
        figures = run.score()
        assert (figures.survival, figures.success, figures.success_s3) == (1.0, 1.0, 1.0)
        assert figures.reward == pytest.approx(1.0)
        assert figures.ticks == figures.scored_ticks == len(clip) - 1
        assert max(figures.global_mm, figures.root_relative_mm, figures.acceleration_m_s2) < 1e-6


def test_without_torque_it_drops_and_the_run_ends_when_nothing_is_left_to_lose():
    clip = swaying_clip(200, name="long")
    (run,) = run_clips(ZeroPolicy(), [clip])
    (whole,) = run_clips(ZeroPolicy(), [clip], stop_when_lost=False)
    assert not run.torque.any()
    assert len(run.torque) < 199 == len(whole.torque)
    assert run.score() == whole.score()
    assert run.score().survival < 0.7


def test_looking_at_past_and_present_is_for_comparisons():
    policy = make_policy(tau=2, future=(0, 3), past=2, scale=0.05)
    assert policy.for_comparison_only
    (run,) = run_clips(policy, [CLIPS[0]])
    first = policy.card.input_size
    assert first == 197 + 2 * 206 + 2 * 197
    assert len(run.torque)


def test_twice_the_speed_is_half_the_ticks():
    (run,) = run_clips(KinematicPolicy(), [CLIPS[1]], Perturbation(speed=2.0))
    assert run.ticks == 39
    assert np.allclose(run.target.root_pos_w[1], CLIPS[1].frames.root_pos_w[4])


def test_a_heavier_body_weighs_more_and_moves_as_mujocos_heavier_body():
    usual, heavy = Simulation(), Simulation()
    scale_mass(heavy, 1.25)
    assert heavy.model.body_mass.sum() == pytest.approx(1.25 * HUMANOID.body_mass.sum())
    assert heavy.model.body_subtreemass[0] == pytest.approx(1.25 * usual.model.body_subtreemass[0])
    servo = ReferenceServo()
    plain, heavier = (run_clips(servo, CLIPS[:1], Perturbation(mass=m))[0] for m in (1.0, 1.25))
    weights = [run.contact_force[-10:].sum(axis=1).mean() for run in (plain, heavier)]
    assert weights[1] / weights[0] == pytest.approx(1.25, abs=0.1)


def test_balls_come_at_the_same_places_every_time_and_push():
    barrage = Perturbation(barrage=Barrage(every_ticks=2, mass_kg=1.0))
    first, second = (run_clips(ReferenceServo(), CLIPS[:2], barrage) for _ in range(2))
    plain = run_clips(ReferenceServo(), CLIPS[:2])
    for one, other, calm in zip(first, second, plain, strict=True):
        assert np.array_equal(pack(one.actual), pack(other.actual))
        assert np.array_equal(pack(one.actual)[:2], pack(calm.actual)[:2])
        assert not np.allclose(
            one.actual.root_pos_w[-1], calm.actual.root_pos_w[len(one.torque) - 1], atol=0.01
        )


def test_mass_and_balls_together_are_refused():
    with pytest.raises(UniconError, match="not both"):
        Perturbation(mass=0.75, barrage=Barrage(10))


def test_policies_without_a_folder_are_known_by_name():
    assert [find_policy(name).name for name in ("zero", "kinematic", "reference_servo")] == [
        "zero",
        "kinematic",
        "reference_servo",
    ]


def test_a_fault_of_the_physics_ends_a_run(monkeypatch):
    step, calls = Simulation.step, []

    def fail_later(self, control):
        calls.append(1)
        result = step(self, control)
        return result if len(calls) < 5 else result._replace(finite=False)

    monkeypatch.setattr(Simulation, "step", fail_later)
    (run,) = run_clips(ReferenceServo(), [replace(CLIPS[0], name="fault")])
    assert len(run.torque) == 4
    assert run.score().first_broken == "physics"
