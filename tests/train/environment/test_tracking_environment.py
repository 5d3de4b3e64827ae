"""Tests for tracking_environment.py."""

from __future__ import annotations

import numpy as np
import pytest

from tests.train.small_library import SIMULATORS, make_dataset
from unicon.humanoid import HUMANOID
from unicon.observation import policy_input
from unicon.reward import RewardTerms, breaks_constraint, reward_terms, total_reward, tracking_errors
from unicon.state import CharacterState, hold
from unicon.target_frames import pack, unpack
from unicon.train.environment.environment_config import EnvironmentConfig
from unicon.train.environment.tracking_environment import TrackingEnvironment

N = 24
QUIET = {"position_noise_m": 0.0, "height_noise_m": 0.0, "joint_noise_rad": 0.0, "velocity_noise": 0.0}
EXACT = {**QUIET, "rsis_share": 0.0}
"""Episodes begin exactly in the target's state."""


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    return make_dataset(tmp_path_factory.mktemp("library"))


@pytest.fixture(params=SIMULATORS)
def simulator(request):
    return request.param


def make(dataset, **changes) -> TrackingEnvironment:
    settings = {"simulator": "mujoco", "num_envs": N, "threads": 1, **changes}
    return TrackingEnvironment(dataset, EnvironmentConfig(**settings))


def zeros() -> np.ndarray:
    return np.zeros((N, 35), np.float32)


def random_actions(count: int, seed: int = 0) -> np.ndarray:
    return 0.2 * np.random.default_rng(seed).standard_normal((count, N, 35)).astype(np.float32)


@pytest.mark.parametrize("control_hz", [30, 60])
@pytest.mark.parametrize("action", ["torque", "torque-servo", "pd", "kinematic"])
@pytest.mark.parametrize("policy", ["zero", "random"])
def test_zero_and_random_policies_run_through_everything(dataset, simulator, action, control_hz, policy):
    env = make(dataset, simulator=simulator, action=action, control_hz=control_hz, observation="tau-2")
    observation = env.reset()
    assert observation.shape == (N, env.observation_size) == (N, 197 + 2 * 206)
    ended = 0
    for actions in random_actions(25) * (policy == "random"):
        step = env.step(actions)
        assert step.observation.dtype == step.reward.dtype == np.float32
        assert step.observation.shape == step.final_observation.shape == (N, env.observation_size)
        assert np.isfinite(step.observation).all() and np.isfinite(step.final_observation).all()
        assert np.all((step.reward >= 0) & (step.reward <= 1.0 + 1e-6))
        assert not np.any(step.terminated & step.truncated)
        ended += np.count_nonzero(step.terminated | step.truncated)
    assert ended > 0


@pytest.mark.parametrize("control_hz", [30, 60])
def test_put_into_the_target_s_pose_the_reward_is_one(dataset, simulator, control_hz):
    env = make(dataset, simulator=simulator, action="kinematic", control_hz=control_hz)
    env.reset()
    for _ in range(10):
        step = env.step(zeros())
        assert np.allclose(step.reward, 1.0, atol=1e-5)
        assert not step.terminated.any()


def clip_frames(env: TrackingEnvironment, ahead: int) -> np.ndarray:
    """The frames that many ahead ``(N, 83)``, read clip by clip; held at rest after the end."""
    rows = []
    for clip, frame, mirrored in zip(env.clips, env.frames + ahead, env.mirrored, strict=True):
        frames = env.dataset.library.get(env.dataset.infos[clip].name).frames
        last = len(frames.joint_pos) - 1
        state = frames[frame] if frame <= last else hold(frames[last])
        rows.append(pack(HUMANOID.mirror(state) if mirrored else state))
    return np.array(rows)


def actual_of(env: TrackingEnvironment) -> CharacterState:
    return unpack(env.simulator.rows.astype(float))


@pytest.mark.parametrize("control_hz", [30, 60])
def test_the_reward_is_the_library_s_for_the_frame_that_the_clip_is_in(dataset, simulator, control_hz):
    env = make(dataset, simulator=simulator, control_hz=control_hz)
    env.reset()
    compared = 0
    for actions in random_actions(12):
        frames = env.frames + 60 // control_hz
        step = env.step(actions)
        going_on = ~(step.terminated | step.truncated)
        assert np.array_equal(env.frames[going_on], frames[going_on])
        terms = reward_terms(tracking_errors(actual_of(env), unpack(clip_frames(env, 0))))
        assert np.allclose(step.reward[going_on], total_reward(terms)[going_on], atol=1e-4)
        assert np.allclose(np.stack(step.terms)[:, going_on], np.stack(terms)[:, going_on], atol=1e-4)
        compared += np.count_nonzero(going_on)
    assert compared > 5 * N


@pytest.mark.parametrize(
    ("observation", "stride", "ahead"),
    [("tau-3", 2, (2, 4, 6)), ("lookahead-5", 1, (5,)), ("frames-0-4-16-64", 1, (0, 4, 16, 64))],
)
def test_the_observation_is_the_library_s(dataset, simulator, observation, stride, ahead):
    env = make(dataset, simulator=simulator, observation=observation, stride=stride)
    env.reset()
    for actions in random_actions(4):
        seen = env.step(actions).observation
        targets = unpack(np.stack([clip_frames(env, k) for k in ahead], axis=1))
        assert np.allclose(seen, policy_input(actual_of(env), targets), atol=2e-4)


def begin_at(env: TrackingEnvironment, frame: int, clip: int = 0, **more) -> None:
    """Put all avatars exactly into a frame of a clip."""
    env.reset()
    places = {"clips": np.full(N, clip), "frames": np.full(N, frame), "mirrored": np.zeros(N, np.bool_)}
    env.restore({**env.state(), **places, **more})
    env.restore({**env.state(), "simulator": env.target.astype(env.simulator.rows.dtype)})


def test_targets_are_as_far_ahead_in_seconds_at_both_control_rates(dataset):
    seen = []
    for control_hz in (30, 60):
        env = make(dataset, control_hz=control_hz, action="kinematic", stride=2)
        begin_at(env, 20 - 60 // control_hz)
        seen.append(env.step(zeros()).observation)
        assert np.all(env.frames == 20)
    assert np.array_equal(*seen)


def test_past_states_stand_behind_the_targets(dataset):
    env = make(dataset, observation="stack-2", constraint=False)
    begin_at(env, 10)
    own = [env.step(actions).observation[:, :197] for actions in random_actions(3)]
    past = env.step(zeros()).observation[:, 197 + 206 :].reshape(N, 2, 197)
    assert np.array_equal(past[:, 0], own[2]) and np.array_equal(past[:, 1], own[1])


def test_a_clip_ends_where_it_has_no_room_for_a_step_and_that_is_no_failure(dataset):
    env = make(dataset, action="kinematic", control_hz=30)
    begin_at(env, 90 - 1 - 5)  # the last frame is 89: two steps of two frames fit
    step = env.step(zeros())
    assert not step.truncated.any() and np.all(env.frames == 86)
    step = env.step(zeros())
    assert step.truncated.all() and not step.terminated.any()
    assert np.all(env.steps == 0)


def test_an_episode_is_truncated_when_its_time_is_over(dataset):
    env = make(dataset, action="kinematic", control_hz=30, episode_s=0.2)
    begin_at(env, 10)
    ended = [env.step(zeros()).truncated.all() for _ in range(6)]
    assert ended == [False] * 5 + [True]


def test_the_final_observation_is_that_of_the_episode_that_ended(dataset):
    env = make(dataset, action="kinematic", control_hz=30, episode_s=2 / 30, stride=2)
    begin_at(env, 10)
    env.step(zeros())
    step = env.step(zeros())
    assert step.truncated.all()
    frames = dataset.library.get("walk_a").frames
    expected = policy_input(frames[14], frames[16:17])
    assert np.allclose(step.final_observation, expected, atol=1e-4)
    # and what follows is the start of the next
    targets = unpack(clip_frames(env, 2)[:, None])
    assert np.allclose(step.observation, policy_input(actual_of(env), targets), atol=1e-4)


def with_terms(env: TrackingEnvironment, terms: tuple[float, ...], steps: int) -> bool:
    """Say whether the first avatar's episode ends with these terms after that many steps."""
    env.steps[:] = steps
    rows = RewardTerms(*(np.full(N, term, np.float32) for term in terms))
    return bool(env.breaks_constraint(rows)[0])


def test_any_term_below_the_threshold_ends_the_episode(dataset):
    env = make(dataset)
    for index in range(5):
        terms = np.full(5, 0.11)
        assert not with_terms(env, tuple(terms), 50)
        terms[index] = 0.09
        assert with_terms(env, tuple(terms), 50)
        assert breaks_constraint(RewardTerms(*terms))


def test_just_after_a_start_only_far_lower_terms_do(dataset):
    env = make(dataset, control_hz=30)
    assert not with_terms(env, (0.05,) * 5, steps=10)
    assert with_terms(env, (0.05,) * 5, steps=11)
    assert with_terms(env, (0.5, 0.5, 0.01, 0.5, 0.5), steps=1)


def test_each_term_can_have_a_threshold_of_its_own(dataset):
    env = make(dataset, thresholds=(0.5, 0.1, 0.1, 0.1, 0.0))
    assert with_terms(env, (0.4, 1, 1, 1, 1), 50)
    assert not with_terms(env, (0.6, 0.2, 0.2, 0.2, 0.001), 50)


def test_thresholds_can_rise_from_loose_to_full(dataset):
    env = make(dataset, loosening_steps=4, action="kinematic")
    env.reset()
    seen = []
    for _ in range(5):
        seen.append(env.thresholds()[0])
        env.step(zeros())
    assert seen == pytest.approx([0.02, 0.04, 0.06, 0.08, 0.1])


def test_without_the_constraint_no_term_ends_an_episode(dataset):
    assert not with_terms(make(dataset, constraint=False), (0.0,) * 5, 50)


def test_a_failed_simulation_ends_with_no_reward_and_nothing_that_is_not_finite(dataset, simulator):
    env = make(dataset, simulator=simulator, constraint=False, action="torque")
    begin_at(env, 10)
    state = env.state()
    state["simulator"][3, 60] = np.nan
    env.restore(state)
    step = env.step(zeros())
    assert np.flatnonzero(step.terminated).tolist() == [3]
    assert step.reward[3] == 0.0 and not np.any(np.stack(step.terms)[:, 3])
    assert np.isfinite(step.observation).all() and np.isfinite(step.final_observation).all()
    assert np.all(env.step(zeros()).reward > 0)


def test_the_start_is_the_state_of_a_frame_five_to_ten_away(dataset):
    env = make(dataset, rsis_share=1.0, mirror_share=0.0, num_envs=N, **QUIET)
    env.reset()
    for env_index in range(N):
        frames = dataset.library.get(dataset.infos[env.clips[env_index]].name).frames
        distance = np.abs(pack(frames) - env.simulator.rows[env_index]).max(axis=1)
        away = abs(int(distance.argmin()) - env.frames[env_index])
        assert distance.min() < 1e-5 and 5 <= away <= 10


def test_without_rsis_and_noise_episodes_begin_in_the_target(dataset, simulator):
    env = make(dataset, simulator=simulator, **EXACT)
    env.reset()
    assert np.allclose(env.simulator.rows, env.target, atol=1e-6)
    assert env.mirrored.any() and not env.mirrored.all()


def test_failures_make_starts_before_them_likelier(dataset):
    env = make(dataset, action="torque", control_hz=60)
    env.reset()
    before = env.sampler.probabilities.copy()
    for _ in range(64):
        env.step(zeros())
    assert env.sampler.failures.failures.sum() > 10
    assert not np.allclose(env.sampler.probabilities, before, rtol=1e-3)


@pytest.mark.parametrize("observation", ["tau-1", "stack-2"])
def test_a_restored_environment_goes_on_to_the_bit(dataset, simulator, observation):
    def go_on(env: TrackingEnvironment) -> list[np.ndarray]:
        steps = [env.step(actions) for actions in random_actions(40, seed=1)]
        return [np.array([np.ravel(getattr(s, name)) for s in steps]) for name in ("observation", "reward")]

    settings = {"simulator": simulator, "observation": observation, "control_hz": 60, "substeps": 2}
    one, two = (make(dataset, **settings) for _ in range(2))
    one.reset()
    for actions in random_actions(5):
        one.step(actions)
    two.reset()
    two.restore(one.state())
    for a, b in zip(go_on(one), go_on(two), strict=True):
        assert np.array_equal(a, b)


def test_the_state_is_a_copy_of_plain_arrays(dataset):
    env = make(dataset)
    env.reset()
    saved = env.state()
    copies = {name: array.copy() for name, array in saved.items()}
    env.step(zeros())
    assert all(np.array_equal(saved[name], copies[name]) for name in saved)
    assert all(array.dtype.kind in "bif" for array in saved.values())


def test_a_state_of_other_sizes_is_refused(dataset):
    env = make(dataset)
    env.reset()
    with pytest.raises(ValueError, match="3 environments, here are 24"):
        env.restore({**env.state(), "clips": np.zeros(3, np.int64)})


def test_seeds_and_ranks_draw_other_starts_and_the_same_seed_the_same(dataset):
    def first(seed: int, rank: int) -> np.ndarray:
        return TrackingEnvironment(
            dataset, EnvironmentConfig(simulator="mujoco", num_envs=N, seed=seed), rank
        ).reset()

    assert np.array_equal(first(0, 0), first(0, 0))
    assert not np.allclose(first(0, 0), first(1, 0))
    assert not np.allclose(first(0, 0), first(0, 1))
