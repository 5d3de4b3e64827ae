"""Tests for bags: written, read by others, mended, proved whole and simulated again to the bit."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from io import StringIO

import numpy as np
import pytest
import yaml
from mcap_ros2.reader import read_ros2_messages
from rich.console import Console
from rosbags.highlevel import AnyReader

from tests.recording.bags import STORE, SessionBag, record_session, targets_message, topic
from tests.samples import START_NS, TICK_NS, message, standing
from unicon.errors import InputFileError
from unicon.recording import bag_writer
from unicon.recording.bag_commands import repair, replay, show_info
from unicon.recording.bag_reading import read_recording
from unicon.recording.bag_repair import repair_bag
from unicon.recording.bag_writer import BagWriter
from unicon.recording.continuity import Continuity
from unicon.recording.replay import replay_bag, replay_recording
from unicon.recording.schema import nested_types
from unicon.target_frames import pack


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bags") / "session"
    record_session(folder)
    return folder


def test_an_independent_reader_finds_every_message(session):
    with AnyReader([session]) as reader:
        counts = {name: info.msgcount for name, info in reader.topics.items()}
        assert counts == {"/a/state": 120, "/a/target_frames": 98, "/a/events": 3}
        connection, _, raw = next(
            reader.messages(connections=[c for c in reader.connections if "state" in c.topic])
        )
        assert reader.deserialize(raw, connection.msgtype).tick == 0


def test_a_second_independent_reader_decodes_it_with_its_own_schemas(session):
    path = session / "session_0.mcap"
    ticks = [m.ros_msg.tick for m in read_ros2_messages(str(path), topics=["/a/state"])]
    assert ticks == list(range(120))


def test_the_metadata_are_rosbag2s(session):
    info = yaml.safe_load((session / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert (info["version"], info["storage_identifier"], info["message_count"]) == (9, "mcap", 221)
    assert info["starting_time"]["nanoseconds_since_epoch"] == START_NS
    assert info["duration"]["nanoseconds"] == 119 * TICK_NS
    assert info["relative_file_paths"] == ["session_0.mcap"]
    assert info["custom_data"] == {"state": "all"}


def test_every_float_comes_back_to_the_bit(tmp_path):
    state = standing(np.nextafter(0.1, 1), -0.0)
    bag = SessionBag(tmp_path / "bag")
    raw = message(2**63, START_NS, state)
    bag.write("/a/target_frames", targets_message(raw), START_NS)
    bag.writer.close()
    again = read_recording(tmp_path / "bag").targets[0]
    assert (again.sequence, again.time_ns) == (2**63, START_NS)
    frame = again.frames[0]
    assert b"".join(v.tobytes() for v in vars(frame).values()) == pack(state).tobytes()


def test_a_folder_that_exists_is_never_overwritten(session):
    with pytest.raises(InputFileError, match="exists already"):
        BagWriter(session)


def test_a_recording_is_simulated_again_to_the_bit(session):
    result = replay_bag(session)
    assert result.difference is None
    assert (result.ticks, result.skipped) == (120, 0)


def test_a_target_that_came_before_the_first_tick_is_replayed_as_it_was(tmp_path):
    record_session(tmp_path / "bag", ticks=20, first_target=0)
    result = replay_bag(tmp_path / "bag")
    assert (result.difference, result.ticks) == (None, 20)


def test_a_recording_that_begins_late_is_simulated_from_its_first_reset(session, tmp_path):
    whole = read_recording(session)
    late = whole._replace(states=whole.states[60:])
    result = replay_recording(late, session)
    assert result.difference is None
    assert (result.first_tick, result.skipped, result.ticks) == (80, 20, 40)


def test_a_recording_without_a_place_to_begin_says_what_to_do(session):
    whole = read_recording(session)
    with pytest.raises(InputFileError, match="in the middle of a motion"):
        replay_recording(whole._replace(states=whole.states[100:]), session)


def test_a_gap_in_the_states_or_targets_is_said(tmp_path):
    session = tmp_path / "long"
    record_session(session, ticks=200)
    whole = read_recording(session)
    with pytest.raises(InputFileError, match="1 states are missing before tick 31"):
        replay_recording(whole._replace(states=whole.states[:30] + whole.states[31:]), session)
    with pytest.raises(InputFileError, match="lacks the target message"):
        torn = [t for t in whole.targets if not 90 <= t.sequence < 95]
        replay_recording(whole._replace(targets=torn), session)


def test_target_messages_that_a_recorder_missed_at_its_very_end_shorten_the_replay(session):
    whole = read_recording(session)
    early = [t for t in whole.targets if t.sequence < 114]
    result = replay_recording(whole._replace(targets=early), session)
    assert result.difference is None
    assert result.ticks == 114


def test_messages_that_are_missing_before_a_reset_do_no_harm(session):
    whole = read_recording(session)
    result = replay_recording(whole._replace(targets=whole.targets[10:]), session)
    assert result.difference is None
    assert result.first_tick == 80


def test_one_float_that_differs_in_its_last_bit_is_found(tmp_path):
    record_session(tmp_path / "bag", spoil_tick=66)
    result = replay_bag(tmp_path / "bag")
    assert result.difference.tick == 66
    assert result.difference.field == "actual"


def test_the_commands_print_what_a_person_wants_to_know(session):
    console = Console(file=StringIO(), width=120)
    assert show_info(session, console) == 0
    assert replay(session, console) == 0
    text = console.file.getvalue()
    assert "/a/target_frames" in text
    assert "bit-exact: 120 ticks" in text


WRITER = """
import sys, time
from pathlib import Path
from tests.recording.bags import SessionBag, targets_message
from tests.samples import START_NS, TICK_NS, message
bag = SessionBag(Path(sys.argv[1]))
for k in range(10**9):
    now = START_NS + k * TICK_NS
    bag.write("/a/target_frames", targets_message(message(k, now)), now)
    bag.writer.flush_when_due()
    time.sleep(0.002)
    if k == 1200:
        print("go", flush=True)
"""


def test_a_killed_recording_is_mended_and_little_is_lost(tmp_path):
    folder = tmp_path / "killed"
    root = os.path.dirname(os.path.dirname(os.path.dirname(__file__)))
    command = [sys.executable, "-c", WRITER, str(folder)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=root)
    process.stdout.readline()
    process.send_signal(signal.SIGKILL)
    process.wait()
    with pytest.raises(InputFileError, match="unicon bag repair"):
        read_recording(folder)
    result = repair_bag(folder)
    numbers = [raw.sequence for raw in read_recording(folder).targets]
    assert numbers == list(range(result.messages))
    assert result.messages > 700
    assert result.kept.exists()
    with pytest.raises(InputFileError, match="needs no repair"):
        repair(folder, Console(file=StringIO()))


def test_a_torn_last_chunk_is_left_out(tmp_path, monkeypatch):
    folder = tmp_path / "torn"
    record_session(folder)
    path = folder / "torn_0.mcap"
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])
    (folder / "metadata.yaml").unlink()
    result = repair_bag(folder)
    assert 0 < result.messages < 221
    assert len(read_recording(folder).states) > 0


@pytest.mark.parametrize("content", [b"", b"no mcap at all" * 100])
def test_what_was_never_a_bag_cannot_be_mended(tmp_path, content):
    folder = tmp_path / "junk"
    folder.mkdir()
    (folder / "junk_0.mcap").write_bytes(content)
    with pytest.raises(InputFileError, match="nothing to mend"):
        repair_bag(folder)
    assert (folder / "junk_0.mcap").read_bytes() == content


def test_a_full_disk_leaves_a_bag_that_can_be_read(tmp_path, monkeypatch):
    """The disk has room for 200 KB until the spare space is given back."""
    original = bag_writer._Disk._write_all
    used = [0]

    def write_all(disk, data):
        used[0] += len(data)
        if used[0] > 200_000 and disk._spare.exists():
            original(disk, data[: len(data) // 2])
            raise OSError(28, "No space left on device")
        original(disk, data)

    monkeypatch.setattr(bag_writer._Disk, "_write_all", write_all)
    bag = SessionBag(tmp_path / "bag")
    rng = np.random.default_rng(0)
    written = 0
    while not bag.writer.full and written < 5000:
        state = standing(*rng.standard_normal(2))
        state = type(state)(**{**vars(state), "joint_pos": rng.standard_normal(35)})
        bag.write("/a/target_frames", targets_message(message(written, START_NS, state)), START_NS)
        written += 1
    assert bag.writer.full
    bag.writer.close()
    assert len(read_recording(tmp_path / "bag").targets) == written


def test_a_missing_number_is_a_gap_and_a_restart_is_none():
    continuity = Continuity()
    for number in (0, 1, 2, 5, 6, 0, 1):
        raw = message(number, START_NS)
        data = bytes(STORE.serialize_cdr(targets_message(raw), "unicon_msgs/msg/TargetFrames"))
        gap = continuity.see_targets(data)
        assert (gap is not None) == (number == 5)
    assert continuity.summary() == {"target_frames of test": "7 received, 2 lost"}


def test_a_message_cut_short_is_refused_not_misread():
    with pytest.raises(InputFileError, match="shorter"):
        Continuity().see_targets(b"\x00\x01\x00\x00\x01")


def test_nested_types_are_found_in_a_definition():
    text = "std_msgs/Header header\nCharacterFrame[] frames  # 1\nuint8 MODE=0\nstring<=8 s\nfloat64[3] x\n"
    assert nested_types(text, "unicon_msgs") == ["std_msgs/Header", "unicon_msgs/CharacterFrame"]


def test_a_definition_holds_each_nested_type_once():
    text = topic("/t", "unicon_msgs/msg/TargetFrames").definition
    assert text.count("MSG: unicon_msgs/CharacterFrame") == 1
    assert text.count("MSG: geometry_msgs/Vector3") == 1


@pytest.mark.parametrize("name", ["missing", "empty"])
def test_what_is_no_bag_is_named(tmp_path, name):
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputFileError, match=name):
        read_recording(tmp_path / name)
