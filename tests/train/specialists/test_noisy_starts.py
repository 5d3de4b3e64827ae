from dataclasses import replace

import numpy as np

from tests.train.small_library import make_dataset
from tests.train.specialists.samples import random_network, small_recipe
from unicon.reward import RewardConfig, RewardTerms
from unicon.train.specialists import noisy_starts
from unicon.train.specialists.noisy_starts import NoisyStarts, far_off


def test_far_off_is_told_from_the_terms():
    # root 0.4 m off and joints 0.05 m: 0.45 m in all; with joints 0.15 m, 0.55 m
    root = np.exp(-10.0 * np.array([0.4, 0.4, 0.51]) ** 2)
    joints = np.exp(-40.0 * np.array([0.05, 0.15, 0.0]) ** 2)
    ones = np.ones(3)
    terms = RewardTerms(root, ones, joints, ones, ones)
    assert far_off(terms, RewardConfig()).tolist() == [False, True, True]


def test_long_clips_are_run_in_pieces_that_cover_them():
    clips, frames = noisy_starts._pieces(np.array([61, 601, 602, 1800]))
    assert clips.tolist() == [0, 1, 2, 2, 3, 3, 3]
    assert frames.tolist() == [0, 0, 0, 300, 0, 599, 1199]


def test_a_policy_is_measured_on_each_clip_and_the_same_again(tmp_path):
    recipe = small_recipe()
    noisy = NoisyStarts(make_dataset(tmp_path), recipe.environment, 2)
    network = random_network(0, recipe)
    first = noisy.measure(network)
    assert [clip.name for clip in first] == ["walk_a", "walk_b", "dance"]
    assert all(0.0 < clip.survival < 1.0 and clip.success == 0.0 for clip in first)
    noisy.measure(random_network(1, recipe))
    assert noisy.measure(network) == first


def test_the_targets_themselves_are_mastered(tmp_path):
    # no physics and no noise: the avatar is in the target all along
    recipe = small_recipe()
    config = replace(
        recipe.environment,
        action="kinematic",
        position_noise_m=0.0,
        height_noise_m=0.0,
        joint_noise_rad=0.0,
        velocity_noise=0.0,
    )
    results = NoisyStarts(make_dataset(tmp_path), config, 1).measure(random_network(0, recipe))
    assert all(clip.mastered for clip in results)
