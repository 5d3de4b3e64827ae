"""Tests for policy_file.py, policy.py and policy_library.py: a network from disk to torque, and refusals."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from tests.samples import standing
from unicon.control import ServoControl
from unicon.errors import InputFileError, UniconError, UnknownNameError
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.observation import OBSERVATION_ID, observe, policy_input, policy_input_size
from unicon.policy import NetworkPolicy, PolicyContext, ReferenceServo
from unicon.policy_file import (
    CARD_FILE,
    WEIGHTS_FILE,
    PolicyCard,
    PolicyMismatchError,
    PolicyWeights,
    read_policy,
    save_policy,
)
from unicon.policy_library import load_policy, policy_names
from unicon.state import stack
from unicon.tracking import Tracker, TrackerConfig


def make_card(**changes) -> PolicyCard:
    card = PolicyCard(
        name="small",
        description="a random network",
        humanoid_id=HUMANOID.id,
        observation_id=OBSERVATION_ID,
        tau=2,
        control_hz=60,
        action="torque",
        activation="relu",
        training_data="none",
    )
    return dataclasses.replace(card, **changes)


def make_weights(tau: int = 2, outputs: int = 35) -> PolicyWeights:
    rng = np.random.default_rng(0)
    sizes = (policy_input_size(tau), 16, outputs)
    layers = tuple(
        (0.05 * rng.standard_normal((b, a), dtype=np.float32), np.zeros(b, np.float32))
        for a, b in zip(sizes[:-1], sizes[1:], strict=True)
    )
    return PolicyWeights(layers, np.zeros(sizes[0], np.float32), np.ones(sizes[0], np.float32))


@pytest.fixture
def folder(tmp_path):
    save_policy(tmp_path / "small", make_card(), make_weights())
    return tmp_path / "small"


def change_card(folder, **values) -> None:
    card = json.loads((folder / CARD_FILE).read_text())
    (folder / CARD_FILE).write_text(json.dumps({**card, **values}))


@pytest.mark.parametrize("activation", ["relu", "elu", "silu", "tanh"])
def test_a_saved_policy_reads_back_and_computes_the_same(tmp_path, activation):
    save_policy(tmp_path / "p", make_card(activation=activation), make_weights())
    card, weights = read_policy(tmp_path / "p")
    seen = np.random.default_rng(1).standard_normal(policy_input_size(2))
    assert card.activation == activation
    assert np.array_equal(weights.evaluate(seen, activation), make_weights().evaluate(seen, activation))


def test_the_torque_is_the_effort_times_the_network_by_hand(folder):
    policy = load_policy(str(folder))
    targets = stack([standing(0.1), standing(0.2)])
    control = policy.act(PolicyContext(standing(), targets))
    (w1, b1), (w2, b2) = make_weights().layers
    seen = np.clip(policy_input(standing(), targets).astype(np.float32), -5, 5)
    expected = w2 @ np.maximum(w1 @ seen + b1, 0) + b2
    assert np.allclose(control.torque, np.clip(HUMANOID.effort * expected, -HUMANOID.effort, HUMANOID.effort))


def test_the_servo_prior_is_added_where_the_card_says_so():
    target = standing()
    target = dataclasses.replace(target, joint_pos=np.full(35, 0.1), joint_vel=np.full(35, 0.2))
    context = PolicyContext(standing(), stack([target, target]))
    plain = NetworkPolicy(make_card(), make_weights()).act(context)
    prior = NetworkPolicy(make_card(action="torque-servo"), make_weights()).act(context)
    unclipped = plain.torque + 0.1 * HUMANOID.stiffness + 0.2 * HUMANOID.damping
    inside = np.abs(plain.torque) < HUMANOID.effort
    expected = np.clip(unclipped, -HUMANOID.effort, HUMANOID.effort)
    assert np.allclose(prior.torque[inside], expected[inside])


def test_a_network_runs_in_the_tracker_and_says_that_it_is_trained(folder):
    tracker = Tracker(TrackerConfig(policy=str(folder)))
    assert (tracker.policy.name, tracker.policy.trained, tracker.policy.tau) == ("small", True, 2)
    assert np.isfinite(tracker.tick(0).torque).all()


def test_another_humanoid_is_refused_with_both_ids(folder):
    change_card(folder, humanoid_id="feedfacefeedface")
    with pytest.raises(PolicyMismatchError, match=f"feedfacefeedface.*{HUMANOID.id}"):
        read_policy(folder)


def test_another_observation_is_refused_with_both_ids(folder):
    change_card(folder, observation_id="0000")
    with pytest.raises(PolicyMismatchError, match=f"0000.*{OBSERVATION_ID}"):
        read_policy(folder)


@pytest.mark.parametrize(("tau", "outputs"), [(1, 35), (2, 34)])
def test_other_sizes_are_refused_with_both_sides(folder, tau, outputs):
    weights = make_weights(tau, outputs)
    tensors = {"input.mean": weights.mean, "input.std": weights.std}
    for i, (w, b) in enumerate(weights.layers):
        tensors |= {f"layers.{i}.weight": w, f"layers.{i}.bias": b}
    save_file(tensors, folder / WEIGHTS_FILE)
    with pytest.raises(PolicyMismatchError, match=f"{policy_input_size(tau)}.*{policy_input_size(2)} inputs"):
        read_policy(folder)


def test_weights_that_were_changed_fail_the_self_check(folder):
    tensors = load_file(folder / WEIGHTS_FILE)
    tensors["layers.1.bias"] = tensors["layers.1.bias"] + np.float32(0.01)
    save_file(tensors, folder / WEIGHTS_FILE)
    with pytest.raises(InputFileError, match="self-check"):
        read_policy(folder)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"tau": 9}, "'tau' is 9"),
        ({"tau": "2"}, "'tau' is a str"),
        ({"activation": "gelu"}, "'activation' is 'gelu'"),
        ({"format": 2}, "'format' is 2"),
        ({"surprise": 1}, "unknown field 'surprise'"),
        ({"control_hz": 30}, "'control_hz' is 30"),
        ({"future": [2]}, "'future' is .2., expected 2 whole numbers"),
        ({"future": [1, 900]}, "'future' is"),
        ({"future": [1, "2"]}, "'future' holds something that is not a number"),
        ({"past": 9}, "'past' is 9"),
    ],
)
def test_a_card_with_a_bad_field_names_it(folder, values, said):
    change_card(folder, **values)
    with pytest.raises(InputFileError, match=said):
        read_policy(folder)


@pytest.mark.parametrize("file", [CARD_FILE, WEIGHTS_FILE])
def test_missing_and_damaged_files_are_named(folder, file):
    content = (folder / file).read_bytes()
    (folder / file).write_bytes(content[: len(content) // 2])
    with pytest.raises(InputFileError, match=file):
        read_policy(folder)
    (folder / file).unlink()
    with pytest.raises(InputFileError, match=file):
        read_policy(folder)


def test_policies_are_found_by_name_and_unknown_ones_get_the_nearest(folder, monkeypatch):
    monkeypatch.setenv("UNICON_POLICIES", str(folder.parent))
    assert policy_names() == ["reference_servo", "small"]
    assert load_policy("small").name == "small"
    with pytest.raises(UnknownNameError, match="small"):
        load_policy("smal")


def test_the_reference_servo_aims_at_the_next_target_and_is_untrained():
    target = dataclasses.replace(standing(), joint_pos=np.full(35, 0.3))
    control = ReferenceServo().act(PolicyContext(standing(), stack([target])))
    assert np.array_equal(control.joint_pos, target.joint_pos)
    assert not ReferenceServo().trained


def test_a_card_of_before_has_its_defaults(folder):
    card = json.loads((folder / CARD_FILE).read_text())
    for name in ("future", "past", "training", "scores", "network"):
        del card[name]
    (folder / CARD_FILE).write_text(json.dumps(card))
    read, _ = read_policy(folder)
    assert (read.frames_ahead, read.past, dict(read.scores)) == ((1, 2), 0, {})


def test_with_pd_the_outputs_offset_the_servo_by_their_torque():
    target = dataclasses.replace(standing(), joint_pos=np.full(35, 0.1), joint_vel=np.full(35, 0.2))
    context = PolicyContext(standing(), stack([target, target]))
    offset = HUMANOID.effort * make_weights().evaluate(policy_input(*context[:2]), "relu")
    control = NetworkPolicy(make_card(action="pd"), make_weights()).act(context)
    assert isinstance(control, ServoControl)
    assert np.allclose(HUMANOID.stiffness * (control.joint_pos - 0.1), offset)
    assert np.array_equal(control.joint_vel, target.joint_vel)


def test_a_policy_looks_at_the_frames_that_its_card_names():
    frames = stack([standing(0.1 * k) for k in range(1, 5)])
    card = make_card(tau=2, future=(2, 4), action="torque-servo")
    policy = NetworkPolicy(card, make_weights())
    seen = policy.observe(PolicyContext(standing(), frames))
    assert policy.tau == 4
    assert np.array_equal(seen, policy_input(standing(), stack([standing(0.2), standing(0.4)])))


def test_past_states_follow_the_targets_and_have_to_be_there():
    policy = NetworkPolicy(make_card(past=1), make_weights())
    targets, before = stack([standing(0.1), standing(0.2)]), standing(-0.1)
    seen = policy.observe(PolicyContext(standing(), targets, past=stack([before])))
    assert policy.for_comparison_only
    assert np.array_equal(seen[-197:], observe(before, forward_kinematics(before)))
    with pytest.raises(UniconError, match="past states"):
        policy.observe(PolicyContext(standing(), targets))


def test_the_present_target_may_be_among_the_frames():
    policy = NetworkPolicy(make_card(tau=2, future=(0, 2)), make_weights())
    targets = stack([standing(0.1), standing(0.2)])
    seen = policy.observe(PolicyContext(standing(), targets, present=standing(0.05)))
    assert np.array_equal(seen, policy_input(standing(), stack([standing(0.05), standing(0.2)])))
    with pytest.raises(UniconError, match="present target"):
        policy.observe(PolicyContext(standing(), targets))


def test_many_avatars_at_once_get_what_each_gets_alone_to_the_bit():
    policy = NetworkPolicy(make_card(action="torque-servo", activation="silu"), make_weights())
    actual = stack([standing(0.01 * k) for k in range(7)])
    targets = stack([stack([standing(0.1 * k), standing(0.2 * k)]) for k in range(7)])
    together = policy.act(PolicyContext(actual, targets)).torque
    alone = [policy.act(PolicyContext(actual[k], targets[k])).torque for k in range(7)]
    assert np.array_equal(together, np.stack(alone))
