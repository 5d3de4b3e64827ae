"""`ros2 service call` and `ros2 action send_goal` of the stand-in: YAML in, the answer as YAML out."""

from __future__ import annotations

import difflib
import importlib
import math
import signal
import time
from collections.abc import Callable
from types import FrameType
from typing import Any

import rclpy
import yaml
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

PATIENCE_S = 5.0
"""How long a server is waited for."""


class CallError(Exception):
    """What is wrong with a call, in one sentence."""


def call_service(name: str, type_name: str, text: str) -> int:
    """Call a service and print the answer; return the exit status."""
    kind = _interface(type_name, "srv")
    request = fill(kind.Request(), _read(text))
    with _Caller() as caller:
        client = caller.node.create_client(kind, name)
        caller.until(client.service_is_ready, f"there is no service {name}: is its node running?", PATIENCE_S)
        print(as_yaml(caller.answer(client.call_async(request))), end="")
    return 0


def send_goal(name: str, type_name: str, text: str, feedback: bool) -> int:
    """Send a goal, print what comes of it, and call it back on Ctrl-C; return the exit status."""
    kind = _interface(type_name, "action")
    goal = fill(kind.Goal(), _read(text))
    with _Caller() as caller:
        client = ActionClient(caller.node, kind, name)
        caller.until(client.server_is_ready, f"there is no action {name}: is its node running?", PATIENCE_S)
        say = (lambda message: print(as_yaml(message.feedback), flush=True)) if feedback else None
        handle = caller.answer(client.send_goal_async(goal, feedback_callback=say))
        if not handle.accepted:
            raise CallError(f"{name} refused the goal; its node says why")
        result = handle.get_result_async()
        try:
            answer = caller.answer(result)
        except KeyboardInterrupt:
            caller.answer(handle.cancel_goal_async())
            answer = caller.answer(result)
        print(as_yaml(answer.result), end="")
    return 0


def fill(message: Any, values: dict[str, Any]) -> Any:
    """Set fields of a message from a mapping, nested ones too; return the message.

    Raises:
        CallError: when a field is unknown, or its value is of another kind.
    """
    kinds = message.get_fields_and_field_types()
    for key, value in values.items():
        if key not in kinds:
            near = difflib.get_close_matches(key, kinds, n=1)
            hint = f"did you mean {near[0]}?" if near else f"it has {', '.join(kinds) or 'no fields'}"
            raise CallError(f"there is no field {key!r}; {hint}")
        old = getattr(message, key)
        if hasattr(old, "get_fields_and_field_types") and isinstance(value, dict):
            fill(old, value)
            continue
        try:
            setattr(message, key, float(value) if isinstance(old, float) else value)
        except (AssertionError, TypeError, ValueError) as error:
            raise CallError(f"the field {key!r} is {value!r}, expected {kinds[key]}") from error
    return message


def as_yaml(message: Any) -> str:
    """Return a message as YAML."""
    return yaml.safe_dump(_plain(message), sort_keys=False, allow_unicode=True)


def _plain(value: Any) -> Any:
    if hasattr(value, "get_fields_and_field_types"):
        return {key: _plain(getattr(value, key)) for key in value.get_fields_and_field_types()}
    if isinstance(value, (str, bool, int, float)):
        return value
    return [_plain(item) for item in value]


def _read(text: str) -> dict[str, Any]:
    try:
        values = yaml.safe_load(text) or {}
    except yaml.YAMLError as error:
        raise CallError(f"{text!r} is no YAML: {error}".replace("\n", " ")) from error
    if not isinstance(values, dict):
        raise CallError(f"{text!r} is no mapping; expected e.g. '{{x: 1.0}}'")
    return values


def _interface(name: str, group: str) -> Any:
    package, *rest = name.split("/")
    if len(rest) != 2 or rest[0] != group:
        raise CallError(f"{name!r} is no type; expected PACKAGE/{group}/TYPE")
    try:
        return getattr(importlib.import_module(f"{package}.{group}"), rest[1])
    except (ImportError, AttributeError) as error:
        raise CallError(f"there is no type {name!r}; see `ros2 interface show`") from error


class _Caller:
    """A node for the time of a call."""

    def __enter__(self) -> _Caller:
        # rclpy's own handler would end the context before a goal can be called back, and an exception that is
        # raised in a callback of rclpy may be lost
        self._interrupted = False
        signal.signal(signal.SIGINT, self._interrupt)
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        self.node = Node("ros2_call")
        return self

    def __exit__(self, *_: object) -> None:
        self.node.destroy_node()
        rclpy.try_shutdown()

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        self._interrupted = True

    def until(self, done: Callable[[], object], why: str, patience_s: float) -> None:
        """Take messages until a condition holds."""
        deadline = time.monotonic() + patience_s
        while not done():
            if self._interrupted:
                self._interrupted = False
                raise KeyboardInterrupt
            if time.monotonic() > deadline:
                raise CallError(why)
            rclpy.spin_once(self.node, timeout_sec=0.05)

    def answer(self, future: Any) -> Any:
        """Return what a future brings, however long that takes."""
        self.until(future.done, "", math.inf)
        return future.result()
