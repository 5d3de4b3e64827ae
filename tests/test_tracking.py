"""Tests for tracking.py: behaviours, hostile messages, and the same results to the bit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.samples import START_NS, TICK_NS, message, raw_frame, standing, swaying
from unicon.commands import LoadPolicy, Reset, SelectSource, ThrowProjectile
from unicon.errors import UnknownNameError
from unicon.projectile import Projectile
from unicon.state import CharacterState, move
from unicon.target_frames import RawTargetFrames, RejectReason, pack
from unicon.tracking import Mode, TickReport, Tracker, TrackerConfig


def run(tracker: Tracker, ticks: int, feed=None, first: int = 0) -> list[TickReport]:
    """Tick; ``feed(tick)`` returns the messages that come before it."""
    reports = []
    for tick in range(first, first + ticks):
        for raw in feed(tick) if feed else ():
            tracker.offer(raw)
        reports.append(tracker.tick(START_NS + tick * TICK_NS))
    return reports


def standing_feed(tick: int) -> list[RawTargetFrames]:
    return [message(tick, START_NS + (tick + 1) * TICK_NS, standing(), standing())]


def far_feed(tick: int) -> list[RawTargetFrames]:
    """A target that runs away: nobody can follow it."""
    state = standing(x=0.3 * tick)
    return [message(tick, START_NS + (tick + 1) * TICK_NS, state, state)]


def bits(report: TickReport) -> bytes:
    parts = [pack(report.actual), pack(report.target), report.torque, report.contact_force]
    return b"".join(np.asarray(p).tobytes() for p in [*parts, np.array(report.reward_terms)])


def test_without_a_target_it_waits_and_stands_still():
    reports = run(Tracker(), 120)
    assert {report.mode for report in reports} == {Mode.WAITING}
    assert abs(reports[-1].actual.root_pos_w[2] - standing().root_pos_w[2]) < 0.01
    assert reports[-1].source == ""


def test_it_follows_a_source_and_says_what_it_took_in():
    reports = run(Tracker(), 60, standing_feed)
    assert reports[-1].mode is Mode.FOLLOWING
    assert reports[7].accepted == (("test", 7),)
    assert min(reports[-1].reward_terms) > 0.95


def test_a_message_that_comes_before_the_first_tick_is_followed_from_it():
    (report,) = run(Tracker(), 1, standing_feed)
    assert report.mode is Mode.FOLLOWING
    assert report.accepted == (("test", 0),)


def test_when_targets_stop_it_holds_after_half_a_second_and_stays_up():
    tracker = Tracker()
    run(tracker, 30, standing_feed)
    reports = run(tracker, 90, first=30)
    modes = [report.mode for report in reports]
    assert modes[:29] == [Mode.FOLLOWING] * 29
    assert set(modes[32:]) == {Mode.HOLDING}
    assert min(reports[-1].reward_terms) > 0.9


def test_a_target_out_of_reach_makes_it_fallen_after_a_second_and_resets_it():
    tracker = Tracker(TrackerConfig(reset_after_s=0.5))
    reports = run(tracker, 150, far_feed)
    modes = [report.mode for report in reports]
    first = modes.index(Mode.FALLEN)
    assert 60 <= first < 75
    assert tracker.falls >= 1
    resets = [k for k in range(1, 150) if reports[k].episode > reports[k - 1].episode]
    assert resets[0] == first + 31
    before, after = reports[resets[0] - 1], reports[resets[0]]
    assert np.linalg.norm(after.actual.root_pos_w - before.target.root_pos_w) < 0.1


def test_without_a_reset_it_tries_to_go_on_and_recovers():
    tracker = Tracker(TrackerConfig(reset_after_s=-1.0))
    run(tracker, 90, far_feed)
    assert tracker.mode is Mode.FALLEN

    def back(tick: int) -> list[RawTargetFrames]:
        return [message(tick, START_NS + (tick + 1) * TICK_NS, *[standing()] * 2, source="back")]

    run(tracker, 120, back, first=90)
    assert tracker.mode is Mode.FOLLOWING
    assert tracker.episode == 0


def test_a_reset_to_rest_forgets_targets_and_sequences():
    tracker = Tracker()
    run(tracker, 60, standing_feed)
    assert tracker.apply(Reset("rest")).success
    report = run(tracker, 1, first=60)[0]
    assert (report.mode, report.episode, report.source) == (Mode.WAITING, 1, "")
    assert tracker.offer(message(0, START_NS + 62 * TICK_NS)) is None


def test_a_reset_to_the_target_needs_one():
    tracker = Tracker()
    refused = tracker.apply(Reset("target"))
    assert not refused.success
    assert "no target" in refused.message
    run(tracker, 10, standing_feed)
    assert tracker.apply(Reset("target")).success


def test_an_unknown_policy_is_refused_and_the_old_one_stays():
    tracker = Tracker()
    result = tracker.apply(LoadPolicy("no_such_policy"))
    assert not result.success
    assert "reference_servo" in result.message
    assert tracker.policy.name == "reference_servo"
    with pytest.raises(UnknownNameError):
        Tracker(TrackerConfig(policy="no_such_policy"))


def test_a_thrown_ball_pushes_the_avatar():
    tracker = Tracker()
    run(tracker, 10)
    assert tracker.apply(ThrowProjectile(Projectile(mass_kg=5.0, speed_m_s=12.0))).success
    moved = [report.actual.root_pos_w[0] for report in run(tracker, 30, first=10)]
    assert min(moved) < -0.05


def test_physics_that_fails_goes_back_to_the_last_good_state_and_leaves_a_dump(tmp_path):
    tracker = Tracker(TrackerConfig(dump_dir=str(tmp_path)))
    run(tracker, 5)
    tracker.simulation._data.qvel[:] = 1e9
    report = run(tracker, 1, first=5)[0]
    assert tracker.faults == 1
    assert np.isfinite(pack(report.actual)).all()
    assert "last good state" in " ".join(report.notices)
    assert list(tmp_path.glob("*.npz"))


def irregular_run(tracker: Tracker) -> list[TickReport]:
    """Two sources, gaps, several messages between ticks, a switch, balls, resets and a fall."""
    rng = np.random.default_rng(5)
    path = swaying(400)
    reports = []
    for tick in range(260):
        now = START_NS + tick * TICK_NS
        for burst in range(rng.integers(0, 3)):
            state = path[tick + burst]
            tracker.offer(message(3 * tick + burst, now + TICK_NS, state, path[tick + burst + 1], source="a"))
        if 80 < tick < 160:
            turned = move(path[tick], 1.0, np.array([4.0, 0.0, 0.0]))
            tracker.offer(message(tick, now + TICK_NS, turned, source="b"))
        commands = {
            100: SelectSource("a"),
            130: SelectSource(""),
            150: ThrowProjectile(Projectile()),
            170: Reset("target"),
            200: Reset("rest"),
        }
        if tick in commands:
            tracker.apply(commands[tick])
        reports.append(tracker.tick(now))
    return reports


def test_the_same_calls_give_the_same_results_to_the_bit():
    first, second = irregular_run(Tracker()), irregular_run(Tracker())
    assert [bits(r) for r in first] == [bits(r) for r in second]
    assert {"a", "b"} <= {report.source for report in first}
    assert first[-1].episode == 2


HOSTILE_FIELDS = st.sampled_from(
    [
        "source",
        "humanoid_id",
        "frames",
        "interval_s",
        "time_ns",
        "root_quat_w",
        "joint_pos",
        "joint_vel",
        "root_pos_w",
    ]
)


def spoil(raw: RawTargetFrames, field: str, rng: np.random.Generator) -> RawTargetFrames:
    """Return the message with one thing in it that must not be."""
    bad = rng.choice([np.nan, np.inf, -np.inf, 1e300, -1e300, 1e12])
    match field:
        case "source":
            return replace(raw, source=str(rng.choice(["", "x" * int(rng.integers(65, 5000))])))
        case "humanoid_id":
            return replace(raw, humanoid_id=rng.bytes(8).hex())
        case "frames":
            return replace(raw, frames=list(raw.frames) * int(rng.choice([0, 65, 10_000])))
        case "interval_s":
            return replace(raw, interval_s=float(rng.choice([0.0, -1.0, np.nan, np.inf, 1e300, 2.0])))
        case "time_ns":
            times = [-1, -(2**70), 2**62, 2**80, raw.time_ns + 10**14, raw.time_ns - 10**14]
            return replace(raw, time_ns=times[rng.integers(len(times))])
        case "root_quat_w":
            value = rng.choice([0.0, 0.5, 1.2, bad])
            return with_field(raw, field, np.array([value, 0.0, 0.0, 0.0]), rng)
    if rng.random() < 0.4:
        size = int(rng.choice([0, 1, 2, 34, 36, 1000]))
        return with_field(raw, field, np.zeros(size), rng)
    value = np.zeros(3 if field == "root_pos_w" else 35)
    value[rng.integers(len(value))] = bad
    return with_field(raw, field, value, rng)


def with_field(
    raw: RawTargetFrames, field: str, value: np.ndarray, rng: np.random.Generator
) -> RawTargetFrames:
    frames = list(raw.frames)
    at = int(rng.integers(len(frames)))
    frames[at] = replace(frames[at], **{field: value})
    return replace(raw, frames=frames)


@pytest.fixture(scope="module")
def besieged() -> tuple[Tracker, Tracker, list[int]]:
    """Two trackers that follow the same source; one is also sent hostile messages."""
    return Tracker(), Tracker(), [0]


@settings(max_examples=100, deadline=None)
@given(fields=st.lists(HOSTILE_FIELDS, min_size=102, max_size=102), seed=st.integers(0, 2**32 - 1))
def test_ten_thousand_hostile_messages_are_counted_and_change_nothing(besieged, fields, seed):
    attacked, calm, clock = besieged
    rng, tick = np.random.default_rng(seed), clock[0]
    clock[0] += 1
    good = message(tick, START_NS + (tick + 1) * TICK_NS, standing(), standing())
    before = attacked.rejected.total()
    for field in fields:
        reason = attacked.offer(spoil(good, field, rng))
        assert isinstance(reason, RejectReason)
    assert attacked.rejected.total() == before + len(fields)
    for tracker in (attacked, calm):
        assert tracker.offer(good) is None
    now = START_NS + tick * TICK_NS
    assert bits(attacked.tick(now)) == bits(calm.tick(now))


def test_an_old_sequence_is_counted():
    tracker = Tracker()
    run(tracker, 5, standing_feed)
    assert tracker.offer(message(2, START_NS + 6 * TICK_NS)) is RejectReason.OLD_SEQUENCE
    assert tracker.rejected[RejectReason.OLD_SEQUENCE] == 1


def test_a_message_of_a_single_frame_is_enough():
    tracker = Tracker()
    bent = CharacterState(**{**vars(standing()), "joint_pos": np.full(35, 0.05)})
    raw = replace(message(0, START_NS + TICK_NS), frames=[raw_frame(bent)])
    run(tracker, 1)
    assert tracker.offer(raw) is None
    report = run(tracker, 30, first=1)[-1]
    assert np.allclose(report.target.joint_pos, 0.05)
