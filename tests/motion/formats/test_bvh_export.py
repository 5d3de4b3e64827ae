"""Tests for bvh_export.py: what readers get back is where our own kinematics put the bodies."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from unicon import rotations
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.humanoid.kinematics import forward_kinematics
from unicon.motion.clip import Clip, clip_from_poses
from unicon.motion.formats.bvh import read_bvh
from unicon.motion.formats.bvh_export import at_60_hz, joint_name, to_bvh, write_bvh
from unicon.motion.formats.motion_file import MotionFile

NAMES = [joint_name(body) for body in HUMANOID.body_names]


def tumbling(count: int = 240, seed: int = 0) -> Clip:
    """All hinges over their whole ranges, while the root turns around and over."""
    rng, times = np.random.default_rng(seed), np.arange(count)[:, None] / 60
    middle = 0.5 * (HUMANOID.joint_lower + HUMANOID.joint_upper)
    size = 0.5 * (HUMANOID.joint_upper - HUMANOID.joint_lower)
    joint_pos = middle + size * np.sin(rng.uniform(1, 3, 35) * times + rng.uniform(0, 6, 35))
    root_quat = rotations.multiply(
        rotations.from_heading(3.0 * times[:, 0]),
        rotations.from_rotation_vector(2.0 * np.sin(times * np.array([1.0, 1.7, 0.3]))),
    )
    root_pos = np.array([0.0, 0.0, 1.0]) + np.sin(times * np.array([0.5, 0.7, 3.0]))
    return clip_from_poses("tumbling", root_pos, root_quat, joint_pos)


def walking_around(count: int = 600) -> Clip:
    """Upright on a circle, three times around."""
    angle = 6.0 * np.pi * np.arange(count) / count
    path = np.stack([np.cos(angle), np.sin(angle), np.full(count, 0.95)], axis=1)
    return clip_from_poses("around", path, rotations.from_heading(angle), np.zeros((count, 35)))


def read_independently(text: str) -> dict[str, np.ndarray]:
    """Read BVH as its description says, with scipy; places ``(T, 3)`` by name, z up, the file's unit."""
    skeleton, _, motion = text.partition("MOTION")
    columns = np.loadtxt(motion.strip().splitlines()[2:], ndmin=2).T
    used, places, turns, names, end_site = 0, {}, {}, [], False
    for words in map(str.split, skeleton.splitlines()):
        if words[0] in ("ROOT", "JOINT"):
            names.append(words[1])
        elif words[0] == "End":
            end_site = True
        elif words[0] == "OFFSET" and not end_site:
            offset = np.array(words[1:], dtype=float)
        elif words[0] == "CHANNELS":
            above = names[-2] if len(names) > 1 else ""
            at = np.zeros(3) if not above else places[above] + turns[above].apply(offset)
            turn = turns.get(above, Rotation.identity())
            for channel in words[2:]:
                axis, value = "XYZ".index(channel[0]), columns[used]
                used += 1
                if channel.endswith("position"):
                    at = at + value[:, None] * np.eye(3)[axis]
                else:
                    turn = turn * Rotation.from_rotvec(np.radians(value)[:, None] * np.eye(3)[axis])
            places[names[-1]], turns[names[-1]] = at, turn
        elif words[0] == "}":
            if not end_site:
                names.pop()
            end_site = False
    return {name: place[:, [2, 0, 1]] for name, place in places.items()}


@pytest.mark.parametrize("make", [tumbling, walking_around, lambda: tumbling(2)])
def test_an_independent_reader_finds_every_joint_where_the_body_is(make):
    clip = make()
    bodies_m = forward_kinematics(clip.frames).pos_w
    found = read_independently(to_bvh(clip.frames))
    for body, name in enumerate(NAMES):
        assert np.abs(0.01 * found[name] - bodies_m[:, body]).max() < 1e-6


@pytest.mark.parametrize(("unit", "metres"), [("cm", 0.01), ("m", 1.0)])
def test_our_own_reader_gives_the_same_motion_back(tmp_path, unit, metres):
    clip = tumbling()
    path = tmp_path / "deeper" / "clip.bvh"
    write_bvh(clip.frames, path, unit)
    motion = read_bvh(MotionFile.from_path(path))
    order = [motion.joint_names.index(name) for name in NAMES]
    bodies_m = forward_kinematics(clip.frames).pos_w
    assert np.abs(metres * motion.global_positions()[:, order] - bodies_m).max() < 1e-4
    assert np.allclose(motion.times_s, np.arange(len(clip)) / 60, atol=1e-6)


def test_the_rest_pose_is_a_t_pose_that_faces_forward(tmp_path):
    path = tmp_path / "clip.bvh"
    write_bvh(tumbling(2).frames, path)
    motion = read_bvh(MotionFile.from_path(path))
    rest = dict(zip(motion.joint_names, motion.rest_positions(), strict=True))
    assert np.allclose(rest["LeftHand"] - rest["LeftArm"], [0.0, 56.0, 0.0])
    assert np.allclose(rest["RightHand"] - rest["RightArm"], [0.0, -56.0, 0.0])
    assert np.allclose(rest["LeftFoot"] - rest["LeftUpLeg"], [0.0, 0.0, -84.5])
    assert np.allclose(rest["LeftToeBase"] - rest["LeftFoot"], [13.5, 0.0, -5.5])


def test_the_file_says_centimetres_y_up_and_60_hz_as_tools_expect():
    rest = HUMANOID.rest_state()
    clip = clip_from_poses(
        "still", *(np.stack([v, v]) for v in (rest.root_pos_w, rest.root_quat_w, rest.joint_pos))
    )
    lines = to_bvh(clip.frames).splitlines()
    assert lines[:2] == ["HIERARCHY", "ROOT Hips"]
    assert (
        lines[4].split() == "CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation".split()
    )
    assert sum("End Site" in line for line in lines) == 5
    assert sum("CHANNELS 3 Zrotation Yrotation Xrotation" in line for line in lines) == 19
    at = lines.index("MOTION")
    assert lines[at + 1 : at + 3] == ["Frames: 2", "Frame Time: 0.0166666667"]
    row = [float(word) for word in lines[at + 3].split()]
    assert row[:6] == [0.0, 95.0, 0.0, 0.0, 0.0, 0.0]
    # Arms hang: from the T-pose the left one turns clockwise about z (to the viewer), the right one back.
    arms = {name: row[6 + 3 * (NAMES.index(name) - 1) :][:3] for name in ("LeftArm", "RightArm")}
    assert arms == {"LeftArm": [-90.0, 0.0, 0.0], "RightArm": [90.0, 0.0, 0.0]}
    assert "-0.000000" not in to_bvh(clip.frames)


@pytest.mark.parametrize("make", [tumbling, walking_around])
def test_curves_do_not_jump_by_whole_turns(make):
    lines = to_bvh(make().frames).splitlines()
    values = np.loadtxt(lines[lines.index("MOTION") + 3 :])[:, 3:]
    assert np.abs(np.diff(values, axis=0)).max() < 180.0
    if make is walking_around:
        assert np.abs(np.diff(values, axis=0)).max() < 2.0
        assert values[-1, 0] > 1070.0


def test_a_file_that_cannot_be_written_is_one_sentence_and_the_old_one_stays(tmp_path, monkeypatch):
    path = tmp_path / "clip.bvh"
    path.write_text("old")

    def fill(*arguments: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("unicon.motion.formats.bvh_export.replace_file", fill)
    with pytest.raises(UniconError, match="clip.bvh: cannot be written \\(No space left on device\\)"):
        write_bvh(tumbling(2).frames, path)
    assert path.read_text() == "old"


def test_frames_that_a_recording_lost_are_filled_in():
    clip = walking_around(120)
    kept = np.delete(np.arange(120), [40, 41, 77])
    frames = at_60_hz(1000.0 + kept / 60, clip.frames[kept])
    assert frames.batch_shape == (120,)
    assert np.allclose(frames.root_pos_w, clip.frames.root_pos_w, atol=0.06)
    assert np.allclose(frames.root_pos_w[kept], clip.frames.root_pos_w[kept], atol=1e-9)
    assert np.allclose(np.linalg.norm(frames.root_quat_w, axis=1), 1.0)


def test_a_recording_of_one_tick_stays_one_frame():
    assert at_60_hz(np.array([3.0]), tumbling(2).frames[:1]).batch_shape == (1,)
