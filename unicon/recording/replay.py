"""Simulates a recording again, in lockstep and without ROS, and compares every state to the bit.

The bag holds all that decided: the configuration (the event "start"), every command with the tick before
which it was applied, and with each tick the target messages that were taken in before it. A replay begins
at the executor's first tick or at a reset to the rest pose, since from there on nothing older matters.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from unicon.commands import Reset, from_json
from unicon.errors import InputFileError, UniconError
from unicon.humanoid import HUMANOID
from unicon.recording.bag_reading import RecordedEvent, RecordedState, Recording, read_recording
from unicon.target_frames import RawTargetFrames, pack
from unicon.tracking import TICK_NS, Mode, TickReport, Tracker, TrackerConfig

TORN_TICKS = 60
"""In how many ticks at the end of a recording target messages may be missing."""


class Difference(NamedTuple):
    """The first place where a replay is not the recording."""

    tick: int
    field: str
    recorded: str
    replayed: str


class Replay(NamedTuple):
    """What a replay found."""

    ticks: int
    """How many ticks were simulated again."""
    first_tick: int
    skipped: int
    """Ticks of the recording before it."""
    difference: Difference | None
    """None when every state agrees to the bit."""


def replay_bag(folder: Path) -> Replay:
    """Simulate a bag again.

    Raises:
        InputFileError: when the bag cannot be read, has gaps, or holds no place to begin.
    """
    return replay_recording(read_recording(folder, ("state", "target_frames", "event")), folder)


def replay_recording(recording: Recording, folder: Path) -> Replay:
    """Simulate a recording again; ``folder`` is named in errors."""
    if not recording.states:
        raise InputFileError(f"{folder}: holds no states of an executor; record the topic state too")
    start = _start_event(recording.events, folder)
    recording = recording._replace(states=_without_torn_end(recording))
    first = _first_state(recording, folder)
    states = recording.states[first:]
    tracker = Tracker(_read_config(start, folder))
    before_ns = recording.states[first - 1].time_ns if first else states[0].time_ns - TICK_NS
    commands = _bring_to(tracker, recording.events, states[0], before_ns)
    inbox = _Inbox(recording.targets, folder)
    for expected, state in enumerate(states, states[0].tick):
        if state.tick != expected:
            lost = state.tick - expected
            raise InputFileError(
                f"{folder}: {lost} states are missing before tick {state.tick}; cannot go on"
            )
        for command in commands.pop(state.tick, []):
            tracker.apply(from_json(command.kind, command.arguments))
        for source, sequence in state.accepted:
            tracker.offer(inbox.take(source, sequence))
        difference = compare(state, tracker.tick(state.time_ns))
        if difference:
            return Replay(state.tick - states[0].tick, states[0].tick, first, difference)
    return Replay(len(states), states[0].tick, first, None)


def _start_event(events: list[RecordedEvent], folder: Path) -> dict[str, Any]:
    found = [event for event in events if event.kind == "start"]
    if not found:
        raise InputFileError(f"{folder}: has no event 'start' of an executor; record the topic events too")
    settings = json.loads(found[-1].arguments)
    if settings["humanoid_id"] != HUMANOID.id:
        other = settings["humanoid_id"]
        raise InputFileError(f"{folder}: was recorded with humanoid {other}, this is {HUMANOID.id}")
    return settings


def _read_config(start: dict[str, Any], folder: Path) -> TrackerConfig:
    try:
        return TrackerConfig(**start["config"])
    except (KeyError, TypeError) as error:
        raise InputFileError(f"{folder}: its event 'start' is of another version ({error})") from error


def _is_clean_start(event: RecordedEvent) -> bool:
    return event.kind == "reset" and from_json(event.kind, event.arguments) == Reset("rest")


def _first_state(recording: Recording, folder: Path) -> int:
    """Return the index of the first state from which a replay can begin."""
    starts = {event.tick for event in recording.events if _is_clean_start(event)} | {0}
    earliest = recording.states[0]
    disturbed = any(e.tick <= earliest.tick and e.kind != "start" for e in recording.events)
    if earliest.mode == Mode.WAITING and not disturbed:
        starts.add(earliest.tick)
    found = [index for index, state in enumerate(recording.states) if state.tick in starts]
    if found:
        whole_from = _whole_from(recording)
        return next((index for index in found if index >= whole_from), found[-1])
    raise InputFileError(
        f"{folder}: begins at tick {recording.states[0].tick}, in the middle of a motion: begin a recording "
        "before the executor, or call the executor's ~/reset once it runs"
    )


def _whole_from(recording: Recording) -> int:
    """Return the index of the first state from which on every followed target message was recorded."""
    recorded = {(message.source, message.sequence) for message in recording.targets}
    lacking = [i for i, state in enumerate(recording.states) if not recorded.issuperset(state.accepted)]
    return lacking[-1] + 1 if lacking else 0


def _without_torn_end(recording: Recording) -> list[RecordedState]:
    """Return the states without the last ones whose target messages came too late to be recorded.

    A recorder that ends while all goes on may have taken in a state but not yet a target message that the
    executor had followed by then.
    """
    recorded = {(message.source, message.sequence) for message in recording.targets}
    count = len(recording.states)
    for index in range(max(count - TORN_TICKS, 1), count):
        if not recorded.issuperset(recording.states[index].accepted):
            return recording.states[:index]
    return recording.states


def _bring_to(
    tracker: Tracker, events: list[RecordedEvent], first: RecordedState, before_ns: int
) -> dict[int, list[RecordedEvent]]:
    """Bring the tracker to the first tick; return the commands from then on by tick.

    ``before_ns`` is the time of the tick before it.
    """
    by_tick: dict[int, list[RecordedEvent]] = {}
    last_start = max(i for i, event in enumerate(events) if event.kind == "start")
    for event in events[last_start + 1 :]:
        if event.tick >= first.tick:
            by_tick.setdefault(event.tick, []).append(event)
        elif event.kind in ("select_source", "load_policy"):
            result = tracker.apply(from_json(event.kind, event.arguments))
            if not result.success:
                raise UniconError(f"the recorded command {event.kind} cannot be repeated: {result.message}")
    resets = any(_is_clean_start(event) for event in by_tick.get(first.tick, []))
    for missed in range(0 if resets else first.tick, 0, -1):
        tracker.tick(first.time_ns - missed * TICK_NS)
    if first.tick:
        tracker.go_on_from(before_ns, first.tick, first.episode - (1 if resets else 0))
    return by_tick


class _Inbox:
    """The recorded target messages, found by source and sequence, in their order."""

    def __init__(self, targets: list[RawTargetFrames], folder: Path) -> None:
        self._messages: dict[tuple[str, int], list[RawTargetFrames]] = {}
        self._folder = folder
        for message in targets:
            self._messages.setdefault((message.source, message.sequence), []).append(message)

    def take(self, source: str, sequence: int) -> RawTargetFrames:
        """Return the next message of that number."""
        waiting = self._messages.get((source, sequence))
        if not waiting:
            raise InputFileError(
                f"{self._folder}: lacks the target message {sequence} of {source!r} that the executor "
                "followed; it was lost in recording, and the replay cannot go on"
            )
        return waiting.pop(0)


def compare(state: RecordedState, report: TickReport) -> Difference | None:
    """Return the first field in which a tick differs from the recording, to the bit."""
    for field, recorded, replayed in _fields(state, report):
        if np.asarray(recorded).tobytes() != np.asarray(replayed).tobytes():
            return Difference(state.tick, field, *_first_difference(recorded, replayed))
    return None


def _fields(state: RecordedState, report: TickReport) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    yield "actual", pack(state.actual), pack(report.actual)
    yield "target", pack(state.target), pack(report.target)
    yield "torque", state.torque, report.torque
    yield "contact_force", state.contact_force, report.contact_force
    yield "reward_terms", state.reward_terms, np.array(report.reward_terms)
    yield "episode", np.array(state.episode), np.array(report.episode)
    yield "mode", np.array(state.mode), np.array(int(report.mode))


def _first_difference(recorded: np.ndarray, replayed: np.ndarray) -> tuple[str, str]:
    a, b = np.atleast_1d(recorded), np.atleast_1d(replayed)
    if a.shape != b.shape:
        return f"{a.size} numbers", f"{b.size} numbers"
    at = int(np.flatnonzero((a != b) | (np.signbit(a) != np.signbit(b)))[0])
    return f"[{at}] {a[at]!r}", f"[{at}] {b[at]!r}"
