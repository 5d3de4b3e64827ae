"""The action `~/go_to`: walks to a point, says how far it still is, and can be cancelled.

A goal is kept as accepted while the character walks and executed when it ends: a coroutine that waits inside
the executor would be asked again and again, and keep it from taking messages.
"""

from __future__ import annotations

import math

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node

from unicon.schedulers.keyboard.go_to import Destination, Progress
from unicon.schedulers.keyboard.scheduler import KeyboardScheduler
from unicon_msgs.action import GoTo

FEEDBACK_FRAMES = 6
STUCK = "no nearer for 5 s: is something in the way?"


class GoToServer:
    """One goal at a time; a new one, a key or a cancel ends the last."""

    def __init__(self, node: Node, scheduler: KeyboardScheduler) -> None:
        self._scheduler, self._logger = scheduler, node.get_logger()
        self._goal: ServerGoalHandle | None = None
        self._frames = 0
        self.server = ActionServer(
            node,
            GoTo,
            "~/go_to",
            lambda goal: GoTo.Result(),
            goal_callback=self._check,
            handle_accepted_callback=self._begin,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    def report(self) -> None:
        """Say how far it is, and end the goal when it has arrived; called once a frame."""
        if self._goal is None:
            return
        progress = self._scheduler.progress
        if self._goal.is_cancel_requested:
            self._scheduler.stop()
            self.end("cancelled")
        elif progress is not None and progress.state != "going":
            self.end(progress.state)
        elif not self._scheduler.going:
            self.end("another command came")
        elif progress is not None:
            self._say(progress)

    def end(self, how: str) -> None:
        """Let the goal that is under way, if there is one, have its result: arrived, or why not."""
        goal, self._goal = self._goal, None
        if goal is not None:
            result = self._result(how)
            goal.execute(lambda handle: _close(handle, result))

    def _check(self, goal: GoTo.Goal) -> GoalResponse:
        numbers = (goal.position.x, goal.position.y, goal.facing, goal.speed)
        if not all(math.isfinite(number) for number in numbers) or goal.speed < 0.0:
            self._logger.warning(f"go_to refused: {numbers}, expected finite numbers and no negative speed")
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def _begin(self, goal: ServerGoalHandle) -> None:
        self.end("another goal came")
        request: GoTo.Goal = goal.request
        facing = request.facing if request.face else None
        place = request.position.x, request.position.y
        speed = request.speed or Destination.speed_m_s
        self._scheduler.go_to(Destination(place, facing, speed))
        self._goal = goal

    def _say(self, progress: Progress) -> None:
        self._frames += 1
        if self._goal is not None and self._frames % FEEDBACK_FRAMES == 0:
            feedback = GoTo.Feedback(distance=progress.distance_m, share=progress.share)
            self._goal.publish_feedback(feedback)

    def _result(self, how: str) -> GoTo.Result:
        progress = self._scheduler.progress
        distance = progress.distance_m if progress is not None else 0.0
        message = {"arrived": f"stands {distance:.2f} m from it", "stuck": STUCK}.get(how, how)
        return GoTo.Result(success=how == "arrived", message=message, distance=distance)


def _close(goal: ServerGoalHandle, result: GoTo.Result) -> GoTo.Result:
    if goal.is_cancel_requested:
        goal.canceled()
    elif result.success:
        goal.succeed()
    else:
        goal.abort()
    return result
