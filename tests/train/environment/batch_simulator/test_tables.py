"""Tests for tables.py."""

from __future__ import annotations

import re

import numpy as np

from unicon.humanoid import HUMANOID
from unicon.humanoid.mjcf import compile_model
from unicon.train.environment.batch_simulator.tables import write_header


def rows(name: str) -> list[list[float]]:
    """Return the numbers of each entry of an array of the header."""
    text = re.search(rf"{name}\[\] = {{\n(.*?)\n}};", write_header(), re.DOTALL)[1]
    return [[float(number) for number in re.findall(r"-?\d[\d.e+-]*", line)] for line in text.splitlines()]


def test_masses_and_hinges_are_the_humanoids():
    bodies, hinges = np.array(rows("BODY")), np.array(rows("HINGE"))
    assert bodies[:, 0].tolist() == HUMANOID.parents.tolist()
    np.testing.assert_allclose(bodies[:, 4], HUMANOID.body_mass)
    np.testing.assert_allclose(
        hinges[:, 3:7].T, [HUMANOID.effort, HUMANOID.stiffness, HUMANOID.damping, HUMANOID.armature]
    )
    assert (HUMANOID.joint_axes[np.arange(35), hinges[:, 0].astype(int)] == 1.0).all()


def test_the_foots_inertia_is_that_of_a_box_about_the_ankle():
    """A box of 0.8 kg, 0.2 x 0.09 x 0.045 m, whose centre is at (0.035, 0, -0.0525) m."""
    foot = rows("BODY")[HUMANOID.body_names.index("left_foot")]
    about_centre = 0.8 / 12 * np.array([0.09**2 + 0.045**2, 0.2**2 + 0.045**2, 0.2**2 + 0.09**2])
    steiner = 0.8 * np.array([0.0525**2, 0.035**2 + 0.0525**2, 0.035**2])
    np.testing.assert_allclose(foot[5:8], [0.028, 0.0, -0.042], atol=1e-9)
    np.testing.assert_allclose(foot[8:11], about_centre + steiner, rtol=1e-6)
    np.testing.assert_allclose(foot[11:14], [0.0, 0.8 * 0.035 * 0.0525, 0.0], rtol=1e-6)


def test_every_solid_shape_is_there_and_no_other():
    model = compile_model()
    shapes = len(rows("CAPSULE")) + len(rows("BOX")) + len(rows("ELLIPSOID"))
    assert shapes == np.count_nonzero(model.geom_conaffinity)
