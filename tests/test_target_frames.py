"""Tests for target_frames.py: what is let through and what is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.samples import START_NS, message, raw_frame, standing
from unicon.target_frames import (
    RejectedTargetsError,
    RejectReason,
    TargetLimits,
    check,
    pack,
    unpack,
)

LIMITS = TargetLimits()


def reason_for(raw, now_ns=START_NS):
    with pytest.raises(RejectedTargetsError) as caught:
        check(raw, now_ns, LIMITS)
    return caught.value.reason


def with_frame(**fields):
    frame = replace(raw_frame(standing()), **fields)
    return replace(message(1, START_NS), frames=[raw_frame(standing()), frame])


def test_a_sound_message_keeps_its_numbers_and_gets_times():
    targets = check(message(7, START_NS, standing(1.0), standing(2.0), interval_s=0.5), START_NS, LIMITS)
    assert (targets.source, targets.sequence) == ("test", 7)
    assert targets.times_ns.tolist() == [START_NS, START_NS + 500_000_000]
    assert targets.frames.root_pos_w[:, 0].tolist() == [1.0, 2.0]


def test_a_quaternion_within_the_tolerance_is_made_unit():
    quat = np.array([1.0005, 0.0, 0.0, 0.0])
    targets = check(with_frame(root_quat_w=quat), START_NS, LIMITS)
    assert np.linalg.norm(targets.frames.root_quat_w, axis=1).tolist() == [1.0, 1.0]


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"source": ""}, RejectReason.BAD_SOURCE),
        ({"source": "x" * 65}, RejectReason.BAD_SOURCE),
        ({"humanoid_id": "another"}, RejectReason.WRONG_HUMANOID),
        ({"frames": []}, RejectReason.NO_FRAMES),
        ({"frames": [None] * 10_000}, RejectReason.TOO_MANY_FRAMES),
        ({"interval_s": 0.0}, RejectReason.BAD_INTERVAL),
        ({"interval_s": float("nan")}, RejectReason.BAD_INTERVAL),
        ({"interval_s": 1.5}, RejectReason.BAD_INTERVAL),
        ({"time_ns": -1}, RejectReason.BAD_TIME),
        ({"time_ns": 2**63 - 1}, RejectReason.BAD_TIME),
        ({"time_ns": START_NS + 61 * 10**9}, RejectReason.BAD_TIME),
        ({"time_ns": START_NS - 2 * 10**9}, RejectReason.BAD_TIME),
    ],
)
def test_a_bad_header_is_refused(changes, reason):
    assert reason_for(replace(message(1, START_NS), **changes)) is reason


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"joint_pos": np.zeros(34)}, RejectReason.WRONG_LENGTH),
        ({"joint_vel": np.zeros(36)}, RejectReason.WRONG_LENGTH),
        ({"joint_vel": np.zeros(0)}, RejectReason.WRONG_LENGTH),
        ({"joint_pos": np.full(35, np.nan)}, RejectReason.NOT_FINITE),
        ({"root_pos_w": np.array([0.0, np.inf, 0.0])}, RejectReason.NOT_FINITE),
        ({"root_quat_w": np.array([0.9, 0.0, 0.0, 0.0])}, RejectReason.NOT_UNIT_QUATERNION),
        ({"root_quat_w": np.zeros(4)}, RejectReason.NOT_UNIT_QUATERNION),
        ({"root_pos_w": np.array([1e5, 0.0, 0.0])}, RejectReason.OUT_OF_RANGE),
        ({"root_pos_w": np.array([0.0, 0.0, -50.0])}, RejectReason.OUT_OF_RANGE),
        ({"root_pos_w": np.array([0.0, 0.0, 25.0])}, RejectReason.OUT_OF_RANGE),
        ({"root_lin_vel_w": np.array([0.0, 0.0, 1e300])}, RejectReason.OUT_OF_RANGE),
        ({"joint_vel": np.full(35, -201.0)}, RejectReason.OUT_OF_RANGE),
    ],
)
def test_a_bad_frame_spoils_the_whole_message(fields, reason):
    assert reason_for(with_frame(**fields)) is reason


def test_before_the_first_tick_any_time_goes():
    assert check(message(1, 12345), None, LIMITS).times_ns[0] == 12345


def test_packing_and_unpacking_is_the_identity():
    state = standing(1.0, 2.0)
    again = unpack(pack(state))
    assert all(np.array_equal(a, b) for a, b in zip(vars(state).values(), vars(again).values(), strict=True))
