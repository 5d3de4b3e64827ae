import numpy as np
import pytest

from unicon.schedulers.pfnn.layout import INPUT_SIZE, OUTPUT_SIZE, unpack_input, unpack_output
from unicon.train.pfnn.normalization import normalization_of, pose_numbers


def _samples(count=500):
    rng = np.random.default_rng(0)
    inputs = (3.0 + rng.standard_normal((count, INPUT_SIZE))).astype(np.float32)
    outputs = (1.0 + 2.0 * rng.standard_normal((count, OUTPUT_SIZE))).astype(np.float32)
    return inputs, outputs, np.arange(count)


def test_means_are_those_of_each_number():
    inputs, outputs, rows = _samples()
    made = normalization_of(inputs, outputs, rows[:100], pose_scale=1.0)
    assert made.input_mean == pytest.approx(inputs[:100].mean(axis=0), abs=1e-5)
    assert made.output_mean == pytest.approx(outputs[:100].mean(axis=0), abs=1e-5)


def test_a_part_has_one_scale_the_mean_of_its_deviations():
    inputs, outputs, rows = _samples()
    inputs[:, 0:24:2] *= np.arange(12)  # x of the path: deviations of about 0 to 11
    made = normalization_of(inputs, outputs, rows, pose_scale=1.0)
    along, across = unpack_input(made.input_std)["path_pos_h"].T
    assert along == pytest.approx([inputs[:, 0:24:2].std(axis=0).mean()] * 12)
    assert across == pytest.approx([inputs[:, 1:24:2].std(axis=0).mean()] * 12)
    hinges = unpack_output(made.output_std)["joint_pos"]
    assert hinges == pytest.approx([outputs[:, -70:-35].std(axis=0).mean()] * 35)


def test_the_pose_is_scaled_down_and_nothing_else():
    inputs, outputs, rows = _samples()
    plain = normalization_of(inputs, outputs, rows, 1.0)
    scaled = normalization_of(inputs, outputs, rows, 0.1)
    assert scaled.input_std[pose_numbers()] == pytest.approx(10 * plain.input_std[pose_numbers()])
    assert np.array_equal(scaled.input_std[:108], plain.input_std[:108])
    assert np.array_equal(scaled.output_std, plain.output_std)


def test_heights_and_angles_of_the_pose_have_scales_of_their_own():
    inputs, outputs, rows = _samples()
    inputs[:, 108] *= 0.01  # height of the root
    pose = normalization_of(inputs, outputs, rows, 1.0).input_std[pose_numbers()]
    assert pose[0] == pytest.approx(inputs[:, 108].std(), rel=1e-4)
    assert pose[1:7] == pytest.approx([pose[1]] * 6)


def test_what_never_changes_is_not_blown_up():
    inputs, outputs, rows = _samples()
    outputs[:, 3] = 7.0
    made = normalization_of(inputs, outputs, rows, 1.0)
    assert made.output_std[3] == pytest.approx(1e-3)
    assert made.output_mean[3] == pytest.approx(7.0)
