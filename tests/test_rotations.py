"""Tests for rotations.py: against scipy, and the algebra as properties."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from unicon import rotations

components = st.floats(-1, 1, allow_nan=False, width=64)
vectors = arrays(np.float64, 3, elements=st.floats(-10, 10, width=64))
quaternions = (
    arrays(np.float64, 4, elements=components)
    .filter(lambda q: np.linalg.norm(q) > 0.1)
    .map(rotations.normalize)
)
angles = st.floats(-np.pi, np.pi).map(np.float64)


def to_scipy(q: np.ndarray) -> Rotation:
    return Rotation.from_quat(rotations.wxyz_to_xyzw(q))


def same_rotation(a: np.ndarray, b: np.ndarray, tolerance: float = 1e-9) -> bool:
    return bool(np.all(np.abs(np.sum(a * b, axis=-1)) > 1 - tolerance))


def random_quaternions(count: int) -> np.ndarray:
    return rotations.normalize(np.random.default_rng(0).standard_normal((count, 4)))


@given(quaternions, quaternions, vectors)
def test_a_product_turns_first_by_the_right_factor(a, b, v):
    assert np.allclose(
        rotations.rotate(rotations.multiply(a, b), v), rotations.rotate(a, rotations.rotate(b, v))
    )


@given(quaternions, vectors)
def test_rotating_agrees_with_scipy_and_its_inverse_takes_it_back(q, v):
    turned = rotations.rotate(q, v)
    assert np.allclose(turned, to_scipy(q).apply(v))
    assert np.allclose(rotations.rotate_inverse(q, turned), v)
    assert np.allclose(rotations.rotate(rotations.conjugate(q), turned), v)


@given(quaternions)
def test_matrices_agree_with_scipy_and_come_back(q):
    matrix = rotations.to_matrix(q)
    assert np.allclose(matrix, to_scipy(q).as_matrix())
    assert same_rotation(rotations.from_matrix(matrix), q)
    assert np.allclose(rotations.to_rot6d(q), np.concatenate([matrix[:, 0], matrix[:, 1]]))


@given(quaternions)
def test_the_logarithm_agrees_with_scipy_and_the_exponential_takes_it_back(q):
    vector = rotations.to_rotation_vector(q)
    assert np.linalg.norm(vector) <= np.pi + 1e-9
    assert same_rotation(rotations.from_rotation_vector(vector), q)
    assert np.isclose(rotations.angle(q), to_scipy(q).magnitude())


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-7, 1e-5])
def test_tiny_rotation_vectors_keep_their_value(size):
    vector = np.array([size, -size, 2 * size])
    assert np.allclose(
        rotations.to_rotation_vector(rotations.from_rotation_vector(vector)), vector, atol=1e-15
    )


def test_a_quarter_turn_about_z_takes_x_to_y():
    q = rotations.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.array(np.pi / 2))
    assert np.allclose(q, [np.sqrt(0.5), 0, 0, np.sqrt(0.5)])
    assert np.allclose(rotations.rotate(q, np.array([1.0, 0.0, 0.0])), [0, 1, 0])
    assert np.isclose(rotations.heading_angle(q), np.pi / 2)


@given(quaternions, angles)
def test_turning_the_world_adds_to_the_heading(q, turn):
    turned = rotations.multiply(rotations.from_heading(turn), q)
    forward = rotations.rotate(q, np.array([1.0, 0.0, 0.0]))
    if np.hypot(forward[0], forward[1]) < 1e-4:
        return
    difference = rotations.heading_angle(turned) - rotations.heading_angle(q) - turn
    assert abs((difference + np.pi) % (2 * np.pi) - np.pi) < 1e-6


@given(quaternions)
def test_what_remains_without_the_heading_faces_forward(q):
    rest = rotations.multiply(rotations.conjugate(rotations.heading(q)), q)
    forward = rotations.rotate(rest, np.array([1.0, 0.0, 0.0]))
    assert abs(forward[1]) < 1e-6


def test_a_vertical_body_still_has_a_heading():
    upwards = rotations.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.array(-np.pi / 2))
    assert np.isfinite(rotations.heading_angle(upwards))


@given(quaternions, quaternions, st.floats(0, 1))
def test_slerp_meets_both_ends_and_turns_at_constant_speed(a, b, t):
    start = rotations.slerp(a, b, np.array(0.0))
    end = rotations.slerp(a, b, np.array(1.0))
    assert same_rotation(start, a)
    assert same_rotation(end, b)
    whole = rotations.angle(rotations.multiply(rotations.conjugate(a), b))
    part = rotations.angle(rotations.multiply(rotations.conjugate(a), rotations.slerp(a, b, np.array(t))))
    assert np.isclose(part, t * whole, atol=1e-6)


def test_the_orders_of_ros_and_mujoco_are_each_others_inverse():
    q = np.array([1.0, 2.0, 3.0, 4.0])
    assert rotations.wxyz_to_xyzw(q).tolist() == [2, 3, 4, 1]
    assert rotations.xyzw_to_wxyz(rotations.wxyz_to_xyzw(q)).tolist() == q.tolist()


UNARY = [
    "to_matrix",
    "to_rot6d",
    "to_rotation_vector",
    "angle",
    "heading",
    "conjugate",
    "normalize",
]


@pytest.mark.parametrize("name", UNARY)
def test_torch_and_numpy_give_the_same(name):
    q = random_quaternions(50)
    function = getattr(rotations, name)
    assert np.allclose(function(torch.from_numpy(q)).numpy(), function(q), atol=1e-12)


def test_batches_of_any_shape_broadcast():
    q = random_quaternions(6).reshape(2, 3, 4)
    v = np.random.default_rng(1).standard_normal(3)
    assert rotations.rotate(q, v).shape == (2, 3, 3)
    assert np.allclose(rotations.rotate(q, v)[1, 2], rotations.rotate(q[1, 2], v))
