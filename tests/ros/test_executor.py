"""Tests for executor_node as a real process."""

from __future__ import annotations

import signal
import time

import numpy as np
import pytest
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from tests.ros.conftest import Graph, end
from tests.samples import TICK_NS, standing, swaying
from unicon.humanoid import HUMANOID
from unicon.state import stack
from unicon_msgs.msg import (
    CharacterFrame,
    CharacterState,
    ExecutorEvent,
    ExecutorStatus,
    HumanoidDescription,
    TargetFrames,
)
from unicon_msgs.srv import LoadPolicy, Reset, SelectSource, Step, ThrowProjectile
from unicon_ros.conversion import to_target_frames
from unicon_ros.qos import COMMAND, EVENTS, EVERYTHING, LATCHED, STREAM, STREAM_SUBSCRIBER

pytestmark = pytest.mark.ros


def start(graph: Graph, **parameters) -> tuple:
    process = graph.start("unicon_executor", "executor_node", **parameters)
    statuses = graph.listen(ExecutorStatus, "status", LATCHED)
    graph.until(lambda: statuses, "the executor's status")
    return process, statuses


class Source:
    """Publishes a standing target whenever it is asked to."""

    def __init__(self, graph: Graph, name: str, quality=STREAM) -> None:
        self.graph, self.name, self.sequence = graph, name, 0
        self.publisher = graph.node.create_publisher(TargetFrames, "target_frames", quality)
        graph.until(lambda: self.publisher.get_subscription_count(), "a subscriber of the targets")

    def send(self, **changes) -> None:
        frames = stack([standing()] * 3)
        message = to_target_frames(self.name, self.sequence, time.time_ns() + TICK_NS, 1 / 60, frames)
        for field, value in changes.items():
            setattr(message, field, value)
        self.publisher.publish(message)
        self.sequence += 1


def feeding(*sources: Source, done):
    """Return a condition that sends a message of each source whenever it is looked at."""

    def look() -> object:
        for source in sources:
            source.send()
        return done()

    return look


def test_it_ticks_at_sixty_hertz_and_publishes_everything(graph):
    process, _ = start(graph)
    states = graph.listen(CharacterState, "state", STREAM_SUBSCRIBER)
    joints = graph.listen(JointState, "joint_states", STREAM_SUBSCRIBER)
    odometry = graph.listen(Odometry, "odom", STREAM_SUBSCRIBER)
    humanoid = graph.listen(HumanoidDescription, "humanoid", LATCHED)
    graph.until(lambda: len(states) > 90 and joints and odometry and humanoid, "the topics of the executor")
    stamps = np.array([s.header.stamp.sec + 1e-9 * s.header.stamp.nanosec for s in states])
    ticks = np.array([s.tick for s in states])
    assert np.isclose(np.median(np.diff(stamps) / np.diff(ticks)), 1 / 60, atol=1e-3)
    assert states[-1].mode == CharacterState.WAITING
    assert joints[-1].name == list(HUMANOID.joint_names)
    assert (humanoid[0].id, len(humanoid[0].body_names)) == (HUMANOID.id, 20)
    assert abs(odometry[-1].pose.pose.position.z - 0.95) < 0.02
    assert end(process) == 0
    assert "Traceback" not in process.output.read_text()


def test_sigterm_ends_it_cleanly(graph):
    process, _ = start(graph)
    assert end(process, signal.SIGTERM) == 0


def test_hostile_messages_are_counted_by_reason_and_do_no_harm(graph):
    _, statuses = start(graph)
    states = graph.listen(CharacterState, "state", STREAM_SUBSCRIBER)
    source = Source(graph, "hostile")
    nan = CharacterFrame()
    nan.root_position.x = float("nan")
    short = CharacterFrame(joint_positions=[0.0] * 3)
    spoilt = {
        "wrong_humanoid": {"humanoid_id": "another"},
        "bad_interval": {"interval": -1.0},
        "no_frames": {"frames": []},
        "too_many_frames": {"frames": [CharacterFrame()] * 100},
        "wrong_length": {"frames": [short]},
        "bad_source": {"source": ""},
    }

    def counted() -> bool:
        for changes in spoilt.values():
            source.send(**changes)
        return set(spoilt) <= set(statuses[-1].rejected_reasons)

    graph.until(counted, "all reasons in the status")
    graph.until(lambda: states, "a state")
    assert states[-1].mode == CharacterState.WAITING
    assert statuses[-1].faults == 0


def test_the_source_that_began_last_is_followed_unless_one_is_selected(graph):
    _, statuses = start(graph)
    first = Source(graph, "first")
    graph.until(feeding(first, done=lambda: statuses[-1].source == "first"), "the first source")
    second = Source(graph, "second")
    graph.until(feeding(first, second, done=lambda: statuses[-1].source == "second"), "the second source")
    answer = graph.call(SelectSource, "executor/select_source", SelectSource.Request(source="first"))
    assert answer.success
    graph.until(feeding(first, second, done=lambda: statuses[-1].source == "first"), "the selected source")
    graph.until(lambda: statuses[-1].mode == CharacterState.HOLDING, "holding after the sources stopped")


def test_pause_step_resume_and_reset(graph):
    _, statuses = start(graph)
    states = graph.listen(CharacterState, "state", EVERYTHING)
    graph.until(lambda: len(states) > 5, "states")
    refused = graph.call(Step, "executor/step", Step.Request(ticks=1))
    assert not refused.success
    assert "pause" in refused.message
    assert graph.call(Trigger, "executor/pause").success
    graph.until(lambda: statuses[-1].mode == CharacterState.PAUSED, "the mode paused")
    answer = graph.call(Step, "executor/step", Step.Request(ticks=10))
    assert answer.success
    graph.until(lambda: states[-1].tick == answer.tick, "the stepped states")
    assert not graph.call(Step, "executor/step", Step.Request(ticks=0)).success
    assert graph.call(Trigger, "executor/resume").success
    graph.until(lambda: states[-1].tick > answer.tick + 10, "ticks after resuming")
    assert not graph.call(Reset, "executor/reset", Reset.Request(to=Reset.Request.TARGET)).success
    assert graph.call(Reset, "executor/reset").success
    graph.until(lambda: states[-1].episode == 1, "the next episode")


def test_commands_are_refused_with_a_sentence_or_logged_as_events(graph):
    start(graph)
    events = graph.listen(ExecutorEvent, "events", EVENTS)
    refused = graph.call(LoadPolicy, "executor/load_policy", LoadPolicy.Request(policy="nonsense"))
    assert not refused.success
    assert "there is no policy 'nonsense'" in refused.message
    refused = graph.call(ThrowProjectile, "executor/throw_projectile", ThrowProjectile.Request(mass=1e9))
    assert "mass_kg" in refused.message
    request = ThrowProjectile.Request(body="head", azimuth=1.0)
    assert graph.call(ThrowProjectile, "executor/throw_projectile", request).success
    graph.until(lambda: len(events) == 2, "the events")
    assert [event.kind for event in events] == ["start", "throw_projectile"]


def test_a_bad_parameter_ends_it_with_one_sentence(graph):
    process = graph.start("unicon_executor", "executor_node", reset_after_s=1e9)
    assert process.wait(timeout=20) == 2
    lines = process.output.read_text().strip().splitlines()
    assert lines[-1].startswith("executor_node: the parameter reset_after_s")
    assert "Traceback" not in "".join(lines)


def run_in_lockstep(graph: Graph) -> list[bytes]:
    process, _ = start(graph, lockstep="true")
    states = graph.listen(CharacterState, "state", COMMAND)
    publisher = graph.node.create_publisher(TargetFrames, "target_frames", COMMAND)
    graph.until(lambda: publisher.get_subscription_count(), "a subscriber of the targets")
    graph.until(lambda: graph.node.count_publishers("/a/state"), "a publisher of states")
    path = swaying(40)
    bits = []
    for k in range(40):
        message = to_target_frames("test", k, 10**15 + k * TICK_NS, 1 / 60, path[k : k + 1])
        publisher.publish(message)
        graph.until(lambda k=k: len(states) > k, f"the state of message {k}")
        state = states[k]
        bits.append(bytes(state.actual.joint_positions) + bytes(state.torques) + bytes([state.mode]))
    end(process)
    return bits


def test_in_lockstep_the_same_messages_give_the_same_bits(graph, tmp_path):
    first = run_in_lockstep(graph)
    graph.close()
    other = Graph(graph.domain, tmp_path)
    try:
        assert run_in_lockstep(other) == first
    finally:
        other.close()
