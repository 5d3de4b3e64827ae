"""Tests for stitching, recorder and executor together, as real processes."""

from __future__ import annotations

import signal

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rosbags.highlevel import AnyReader
from std_srvs.srv import Trigger

from tests.ros.conftest import end
from unicon.recording.bag_reading import read_recording
from unicon.recording.replay import replay_bag
from unicon.recording.session_report import report_on
from unicon_msgs.msg import CharacterState, ExecutorStatus, SchedulerStatus
from unicon_msgs.srv import ListMotions, QueueMotion, Reset, StartRecording
from unicon_ros.qos import COMMAND, LATCHED, STREAM_SUBSCRIBER

pytestmark = pytest.mark.ros


def test_motions_are_listed_queued_played_and_cleared(graph, library):
    graph.start("unicon_schedulers", "stitching_node", library=library)
    statuses = graph.listen(SchedulerStatus, "stitching/status", LATCHED)
    motions = graph.call(ListMotions, "stitching/list_motions").motions
    assert [m.name for m in motions] == ["bow", "sway"]
    assert abs(motions[1].duration - 119 / 60) < 1e-9
    unknown = graph.call(QueueMotion, "stitching/queue_motion", QueueMotion.Request(name="swey"))
    assert not unknown.success
    assert "the nearest are sway" in unknown.message
    long = QueueMotion.Request(name="bow", transition=99.0)
    assert "expected 0 to 5" in graph.call(QueueMotion, "stitching/queue_motion", long).message
    for name in ("sway", "bow"):
        request = QueueMotion.Request(name=name, transition=-1.0)
        assert graph.call(QueueMotion, "stitching/queue_motion", request).success
    graph.until(lambda: statuses[-1].playing == "sway", "the motion that plays")
    assert not statuses[-1].empty
    assert graph.call(Trigger, "stitching/clear_queue").success
    graph.until(lambda: statuses[-1].empty, "an empty queue")


def test_a_session_is_recorded_whole_and_simulated_again_to_the_bit(graph, library, tmp_path):
    bag = tmp_path / "session"
    recorder = graph.start("unicon_recorder", "recorder_node", output=bag)
    executor = graph.start("unicon_executor", "executor_node")
    stitching = graph.start("unicon_schedulers", "stitching_node", library=library)
    states = graph.listen(CharacterState, "state", STREAM_SUBSCRIBER)
    diagnostics = graph.listen(DiagnosticArray, "/diagnostics", COMMAND)

    def received() -> set[str]:
        statuses = [status for message in diagnostics for status in message.status]
        return {value.key for s in statuses if s.name == "/a/recorder" for value in s.values}

    streams = {"state", "target_frames of stitching"}
    graph.until(lambda: received() >= streams, "the recorder receiving both streams")
    assert graph.call(Reset, "executor/reset").success
    assert graph.call(QueueMotion, "stitching/queue_motion", QueueMotion.Request(name="sway")).success
    last = states[-1].tick
    graph.until(lambda: states[-1].tick > last + 120, "two seconds of motion")
    assert [end(process) for process in (stitching, executor, recorder)] == [0, 0, 0]
    with AnyReader([bag]) as reader:
        topics = set(reader.topics)
    taken = {"/a/state", "/a/target_frames", "/a/events"}
    assert taken | {"/a/joint_states", "/a/odom", "/a/markers", "/a/status", "/diagnostics"} <= topics
    result = replay_bag(bag)
    assert result.difference is None
    assert result.ticks > 100
    report = report_on(bag)
    assert report.lost_messages == 0
    assert "0 lost" in recorder.output.read_text()


def test_a_killed_scheduler_started_again_is_followed_again(graph, library):
    graph.start("unicon_executor", "executor_node")
    statuses = graph.listen(ExecutorStatus, "status", LATCHED)
    first = graph.start("unicon_schedulers", "stitching_node", library=library)
    graph.until(lambda: statuses and statuses[-1].mode == CharacterState.FOLLOWING, "following")
    end(first, signal.SIGKILL)
    graph.until(lambda: statuses[-1].mode == CharacterState.HOLDING, "holding")
    graph.start("unicon_schedulers", "stitching_node", library=library)
    graph.until(lambda: statuses[-1].mode == CharacterState.FOLLOWING, "following again")


def test_a_recording_is_started_and_stopped_by_service(graph, tmp_path):
    recorder = graph.start("unicon_recorder", "recorder_node", start="false")
    graph.start("unicon_executor", "executor_node")
    assert not graph.call(Trigger, "recorder/stop").success
    bag = tmp_path / "bag"
    assert graph.call(StartRecording, "recorder/start", StartRecording.Request(output=str(bag))).success
    again = graph.call(StartRecording, "recorder/start", StartRecording.Request(output=str(bag)))
    assert "runs already" in again.message
    states = graph.listen(CharacterState, "state", STREAM_SUBSCRIBER)
    graph.until(lambda: len(states) > 60, "some states")
    assert graph.call(Trigger, "recorder/stop").success
    assert len(read_recording(bag).states) > 10
    refused = graph.call(StartRecording, "recorder/start", StartRecording.Request(output=str(bag)))
    assert "exists already" in refused.message
    assert end(recorder) == 0


def test_a_library_that_is_not_there_ends_the_scheduler_with_one_sentence(graph, tmp_path):
    process = graph.start("unicon_schedulers", "stitching_node", library=tmp_path / "none")
    assert process.wait(timeout=20) == 2
    assert "there is no such clip library" in process.output.read_text()
    assert "Traceback" not in process.output.read_text()
