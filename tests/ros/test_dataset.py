"""Tests for the dataset scheduler as a real process."""

from __future__ import annotations

from pathlib import Path

import pytest
from std_srvs.srv import Trigger

from tests.ros.conftest import end
from tests.samples import swaying_clip
from unicon.motion.clip_index import ClipInfo
from unicon.motion.store.library_writer import LibraryWriter
from unicon_msgs.msg import CharacterState, ExecutorStatus, SchedulerStatus, TargetFrames
from unicon_msgs.srv import Play
from unicon_ros.qos import LATCHED, STREAM_SUBSCRIBER

pytestmark = pytest.mark.ros


@pytest.fixture
def classes(tmp_path: Path) -> Path:
    """A library of two classes."""
    folder = tmp_path / "classes"
    with LibraryWriter(folder) as writer:
        for name, label in (("sway", "idle/sway"), ("rock", "idle/rock"), ("bow", "greeting")):
            clip = swaying_clip(90, name=name)
            writer.add(ClipInfo(name, len(clip), label, name), clip.frames)
        writer.commit()
    return folder


def test_the_executor_follows_what_is_asked_for_by_service(graph, classes):
    graph.start("unicon_executor", "executor_node")
    dataset = graph.start("unicon_schedulers", "dataset_node", library=classes, play="greeting")
    plays = graph.listen(SchedulerStatus, "dataset/status", LATCHED)
    statuses = graph.listen(ExecutorStatus, "status", LATCHED)
    frames = graph.listen(TargetFrames, "target_frames", STREAM_SUBSCRIBER)
    following = CharacterState.FOLLOWING
    graph.until(lambda: plays and plays[-1].playing == "bow", "the class that was asked for at the start")
    graph.until(lambda: statuses and statuses[-1].mode == following, "the executor following")
    assert statuses[-1].source == "dataset"
    request = Play.Request(what="idle", speed=2.0, loop=True)
    answer = graph.call(Play, "dataset/play", request)
    assert answer.success
    assert answer.clips == 2
    assert answer.message == "plays class idle, 2 to choose from, 2 times as fast as captured"
    graph.until(lambda: plays[-1].playing in ("sway", "rock"), "a clip of the class")
    assert len(frames[-1].frames) == 8
    assert end(dataset) == 0


def test_a_clip_is_played_once_and_requests_that_cannot_be_are_answered(graph, classes):
    graph.start("unicon_schedulers", "dataset_node", library=classes)
    plays = graph.listen(SchedulerStatus, "dataset/status", LATCHED)
    graph.until(lambda: plays and plays[-1].playing, "random clips")
    unknown = graph.call(Play, "dataset/play", Play.Request(what="swey"))
    assert not unknown.success
    assert "the nearest are sway" in unknown.message
    fast = graph.call(Play, "dataset/play", Play.Request(what="sway", speed=5.0))
    assert not fast.success
    assert "the speed is 5, expected 0.1 to 4" in fast.message
    assert graph.call(Play, "dataset/play", Play.Request(what="sway", loop=False)).clips == 1
    graph.until(lambda: plays[-1].playing == "sway", "the clip")
    graph.until(lambda: plays[-1].empty, "standing after it")
    graph.call(Play, "dataset/play", Play.Request(loop=True))
    graph.until(lambda: plays[-1].playing, "random clips again")
    assert graph.call(Trigger, "dataset/stop").success
    graph.until(lambda: plays[-1].empty, "standing")


def test_an_unknown_class_ends_the_node_with_one_sentence(graph, classes):
    process = graph.start("unicon_schedulers", "dataset_node", library=classes, play="greting")
    assert process.wait(timeout=20) == 2
    output = process.output.read_text()
    assert "there is no clip and no class 'greting'; the nearest are greeting/" in output
    assert "Traceback" not in output
