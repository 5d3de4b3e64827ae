"""Tests for generator.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.schedulers.keyboard.steerable import Steerable
from unicon import rotations
from unicon.humanoid import HUMANOID
from unicon.schedulers.keyboard.command import STAND, LocomotionCommand
from unicon.schedulers.keyboard.generator import GeneratorConfig, PoseGenerator, quat_from_rot6d
from unicon.schedulers.pfnn.layout import OUTPUT_SIZE, pack_output, unpack_output


def generator(network=None) -> PoseGenerator:
    return PoseGenerator(network or Steerable(), GeneratorConfig())


def test_it_goes_at_the_commanded_velocity():
    maker = generator()
    path = [maker.step(LocomotionCommand((1.2, 0.4))).root_pos_w for _ in range(240)]
    velocity = (path[-1] - path[-61])[:2]
    assert np.allclose(velocity, [1.2, 0.4], atol=0.05)


def test_it_turns_at_the_commanded_rate_and_its_root_faces_there():
    maker = generator()
    for _ in range(180):
        maker.step(LocomotionCommand((1.0, 0.0), 0.8))
    before = maker.heading
    for _ in range(60):
        state = maker.step(LocomotionCommand((1.0, 0.0), 0.8))
    assert maker.heading - before == pytest.approx(0.8, abs=0.03)
    off = rotations.heading_angle(state.root_quat_w) - maker.heading
    assert np.cos(off) == pytest.approx(1.0)


def test_who_stands_does_stand():
    maker = generator()
    for _ in range(120):
        maker.step(LocomotionCommand((1.2, 0.0)))
    for _ in range(180):
        maker.step(STAND)
    phase, place = maker.phase, maker.state.root_pos_w
    state = [maker.step(STAND) for _ in range(60)][-1]
    assert maker.phase == phase
    assert np.array_equal(state.root_pos_w, place)
    assert not state.root_lin_vel_w.any()


def test_a_network_that_jumps_into_a_run_is_played_slower_as_a_whole():
    class Sprinter(Steerable):
        def predict(self, x, phase):
            parts = unpack_output(super().predict(x, phase))
            parts["root_vel_h"] = np.array([2.4, 0.0])
            parts["joint_vel"] = np.full(35, 3.0)
            return pack_output(parts)

    maker = generator(Sprinter())
    command = LocomotionCommand((2.4, 0.0))
    for frame in range(60):
        before = maker.phase
        state = maker.step(command)
        speed = state.root_lin_vel_w[0]
        assert speed <= 1.6 * frame / 60 + 0.25 + 1e-9
        share = speed / 2.4
        assert maker.phase - before == pytest.approx(share * 6.0 / 60)
        assert state.joint_vel == pytest.approx(share * 3.0)
    for _ in range(60):
        state = maker.step(command)
    assert state.root_lin_vel_w[0] == pytest.approx(2.4)


def test_velocities_are_those_of_the_frames():
    maker = generator()
    frames = [maker.step(LocomotionCommand((1.0, 0.0), 0.5)) for _ in range(90)]
    steps = (frames[-1].root_pos_w - frames[-2].root_pos_w) * 60
    assert np.allclose(frames[-1].root_lin_vel_w, steps)
    assert frames[-1].root_ang_vel_w[2] == pytest.approx(0.5, abs=0.05)


@settings(max_examples=5, deadline=None)
@given(st.floats(-3, 3), st.floats(-9, 9))
def test_what_it_does_turns_and_shifts_with_where_it_is_placed(heading, shift):
    here, there = generator(), generator()
    there.place(np.array([shift, 1.0]), heading)
    command = LocomotionCommand((1.0, 0.3), 0.7)
    for _ in range(40):
        ours, theirs = here.step(command), there.step(command)
    turned = rotations.rotate(rotations.from_heading(np.array(heading)), ours.root_pos_w)
    assert np.allclose(turned + [shift, 1.0, 0.0], theirs.root_pos_w, atol=1e-7)
    assert np.allclose(ours.joint_pos, theirs.joint_pos)


def test_an_answer_that_is_not_finite_makes_it_stand_again_where_it_is():
    class Broken(Steerable):
        def predict(self, x, phase):
            y = super().predict(x, phase)
            return np.full(OUTPUT_SIZE, np.nan) if self.asked == 100 else y

    maker = generator(Broken())
    frames = [maker.step(LocomotionCommand((1.2, 0.0))) for _ in range(101)]
    assert maker.failures == 1
    assert np.isfinite(frames[-1].root_pos_w).all()
    assert np.allclose(frames[99].root_pos_w[:2], frames[98].root_pos_w[:2])
    assert np.allclose(frames[99].joint_pos, HUMANOID.rest_state().joint_pos)


@pytest.mark.parametrize(
    ("part", "value"),
    [
        ("root_rot6d_h", np.zeros(6)),
        ("root_rot6d_h", np.array([1.0, 0, 0, 2.0, 0, 0])),
        ("root_height", np.array([1e308])),
    ],
)
def test_a_finite_answer_that_makes_no_pose_makes_it_stand_again_where_it_is(part, value):
    class Useless(Steerable):
        def predict(self, x, phase):
            parts = unpack_output(super().predict(x, phase))
            return pack_output({**parts, part: value} if self.asked == 100 else parts)

    maker = generator(Useless())
    frames = [maker.step(LocomotionCommand((1.2, 0.0))) for _ in range(130)]
    assert maker.failures == 1
    assert all(np.isfinite(values).all() for frame in frames for values in vars(frame).values())
    assert np.allclose(frames[99].root_pos_w[:2], frames[98].root_pos_w[:2])
    assert np.allclose(frames[99].joint_pos, HUMANOID.rest_state().joint_pos)


def test_hinges_stay_within_their_limits():
    class Wild(Steerable):
        def predict(self, x, phase):
            y = super().predict(x, phase)
            y[-70:-35] = 9.0
            return y

    assert np.array_equal(generator(Wild()).step(STAND).joint_pos, HUMANOID.joint_upper)


def test_two_columns_that_are_not_quite_square_give_a_rotation():
    quat = rotations.normalize(np.array([0.9, 0.1, -0.3, 0.2]))
    columns = rotations.to_rot6d(quat)
    skewed = np.concatenate([1.3 * columns[:3], columns[3:] + 0.2 * columns[:3]])
    assert abs(np.sum(quat_from_rot6d(skewed) * quat)) == pytest.approx(1.0)
