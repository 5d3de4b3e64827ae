"""`ros2 run unicon_executor executor_node`: simulates one avatar that follows target frames at 60 Hz.

One thread: ticks at absolute deadlines, messages in the slack between them. Callbacks only check and
store; everything that moves the avatar is in `unicon.tracking`.
"""

from __future__ import annotations

import gc
import os
import time

from rclpy.executors import Executor
from rclpy.node import Node
from std_srvs.srv import Trigger

from unicon.commands import (
    Command,
    LoadPolicy,
    Reset,
    SelectSource,
    ThrowProjectile,
    kind_of,
    to_json,
)
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.pacing import Pacer, PacerConfig
from unicon.projectile import Projectile
from unicon.target_frames import NS_PER_S
from unicon.tracking import (
    TICK_NS,
    CommandResult,
    Mode,
    TickReport,
    Tracker,
    TrackerConfig,
    config_to_dict,
)
from unicon_executor.parameters import PARAMETERS
from unicon_executor.publishers import ExecutorPublishers
from unicon_msgs.msg import ExecutorStatus, TargetFrames
from unicon_msgs.srv import LoadPolicy as LoadPolicyService
from unicon_msgs.srv import Reset as ResetService
from unicon_msgs.srv import SelectSource as SelectSourceService
from unicon_msgs.srv import Step
from unicon_msgs.srv import ThrowProjectile as ThrowProjectileService
from unicon_ros.conversion import from_target_frames, to_stamp
from unicon_ros.diagnostics import OK, WARN, Diagnostics
from unicon_ros.parameters import declare_parameters
from unicon_ros.process import PATIENCE_S, StopFlag, run_node
from unicon_ros.qos import COMMAND, STREAM_SUBSCRIBER

STATUS_PERIOD_S = 0.5
DIAGNOSTICS_PERIOD_S = 1.0
MAX_STEPS = 3600
WARM_UP_TICKS = 30
MESSAGES_A_TICK = 4
"""How many waiting messages are taken in even when there is no slack."""


class ExecutorNode(Node):
    """The executor.

    Raises:
        UniconError: when a parameter or the policy cannot be used.
    """

    def __init__(self) -> None:
        super().__init__("executor")
        values = declare_parameters(self, PARAMETERS)
        self._lockstep: bool = values["lockstep"]
        config = TrackerConfig(
            policy=values["policy"],
            source=values["source"],
            reset_after_s=values["reset_after_s"],
            dump_dir=values["dump_dir"],
        )
        self.tracker = Tracker(config)
        self._pacer_config = PacerConfig(slow_motion=values["slow_motion"])
        self._priority: int = values["realtime_priority"]
        self._paused = False
        self._last_target_ns: int | None = None
        self._last_shown: tuple[object, ...] = ()
        self._outputs = ExecutorPublishers(self, values["markers_hz"], self._lockstep)
        self._diagnostics = Diagnostics(self)
        self._last_time_ns = time.time_ns()
        self._outputs.publish_start(
            self._last_time_ns, {"config": config_to_dict(config), "humanoid_id": HUMANOID.id}
        )
        self._create_interfaces()

    def _create_interfaces(self) -> None:
        quality = COMMAND if self._lockstep else STREAM_SUBSCRIBER
        self.create_subscription(TargetFrames, "target_frames", self._take_targets, quality)
        self.create_service(Trigger, "~/pause", self._pause)
        self.create_service(Trigger, "~/resume", self._resume)
        self.create_service(Step, "~/step", self._step)
        self.create_service(ResetService, "~/reset", self._reset)
        self.create_service(LoadPolicyService, "~/load_policy", self._load_policy)
        self.create_service(SelectSourceService, "~/select_source", self._select_source)
        self.create_service(ThrowProjectileService, "~/throw_projectile", self._throw_projectile)
        self.create_timer(STATUS_PERIOD_S, self._publish_status)
        self.create_timer(DIAGNOSTICS_PERIOD_S, self._publish_diagnostics)

    def run(self, executor: Executor, stop: StopFlag) -> None:
        """Tick until told to stop."""
        self._warm_up()
        self._pacer = Pacer(self._pacer_config, time.time_ns())
        shown = f"policy {self.tracker.policy.name}" + ("" if self.tracker.policy.trained else " (untrained)")
        self.get_logger().info(f"ready: humanoid {HUMANOID.id}, {shown}")
        self._publish_status()
        while not stop:
            if self._lockstep or self._paused:
                executor.spin_once(timeout_sec=PATIENCE_S)
                continue
            remaining_s = self._pacer.remaining_s()
            if remaining_s > 0:
                executor.spin_once(timeout_sec=remaining_s)
            else:
                self._run_tick(executor)

    def close(self) -> None:
        """Say a last time how it went."""
        if hasattr(self, "_pacer"):
            self._publish_status()

    def _warm_up(self) -> None:
        """Run some ticks on a tracker of its own, so that the first real one is not the slowest."""
        spare = Tracker()
        for _ in range(WARM_UP_TICKS):
            spare.tick(0)
        gc.collect()
        gc.freeze()
        if self._priority:
            try:
                os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(self._priority))
            except PermissionError:
                self.get_logger().warning("no permission for realtime_priority; goes on without")

    def _run_tick(self, executor: Executor) -> None:
        behind = self._pacer.remaining_s() < -TICK_NS / NS_PER_S
        for _ in range(MESSAGES_A_TICK if behind else 0):
            executor.spin_once(timeout_sec=0)
        if self._pacer.begin() and not self._pacer_config.slow_motion:
            self.get_logger().warning("fell 100 ms behind; the clock was set anew")
        report = self._tick(self._pacer.tick_time_ns)
        self._pacer.finish()
        self._tell(report)

    def _tick(self, time_ns: int) -> TickReport:
        """One tick at ``time_ns``: targets, policy, physics, and the state that came of it."""
        self._last_time_ns = time_ns
        age_s = self._target_age_s()
        report = self.tracker.tick(time_ns)
        self._outputs.publish_state(report, age_s)
        return report

    def _tell(self, report: TickReport) -> None:
        """Tell the rest of a tick in the slack before the next."""
        self._outputs.publish_views(report)
        for notice in report.notices:
            self.get_logger().info(notice)
        shown = (report.mode, report.source, self.tracker.policy.name)
        if shown != self._last_shown:
            self._last_shown = shown
            self._publish_status()

    def _target_age_s(self) -> float:
        if self._last_target_ns is None:
            return -1.0
        return (time.monotonic_ns() - self._last_target_ns) / NS_PER_S

    def _take_targets(self, message: TargetFrames) -> None:
        if self._paused and not self._lockstep:
            return
        raw = from_target_frames(message)
        reason = self.tracker.offer(raw)
        if reason is not None:
            text = f"refused a target message of {message.source[:64]!r}: {reason}"
            self.get_logger().warning(text, throttle_duration_sec=5.0)
            return
        self._last_target_ns = time.monotonic_ns()
        if self._lockstep and not self._paused:
            self._tell(self._tick(raw.time_ns - TICK_NS))

    def _apply(self, command: Command) -> CommandResult:
        result = self.tracker.apply(command)
        if result.success:
            self._outputs.publish_event(
                self._last_time_ns, self.tracker.ticks, kind_of(command), to_json(command)
            )
        self._publish_status()
        return result

    def _pause(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success, response.message = not self._paused, "paused"
        if self._paused:
            response.message = "it is paused already"
        self._paused = True
        self._publish_status()
        return response

    def _resume(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success, response.message = self._paused, "goes on"
        if not self._paused:
            response.message = "it is not paused"
        self._paused = False
        self._pacer.resume()
        self._publish_status()
        return response

    def _step(self, request: Step.Request, response: Step.Response) -> Step.Response:
        response.success = self._paused and 1 <= request.ticks <= MAX_STEPS
        if response.success:
            for _ in range(request.ticks):
                self._tell(self._tick(self._last_time_ns + TICK_NS))
            response.message = f"advanced by {request.ticks} ticks"
        elif not self._paused:
            response.message = "it is not paused: call ~/pause first"
        else:
            response.message = f"{request.ticks} ticks were asked for, expected 1 to {MAX_STEPS}"
        response.tick = max(self.tracker.ticks - 1, 0)
        return response

    def _reset(self, request: ResetService.Request, response: ResetService.Response) -> ResetService.Response:
        to_rest = request.to == ResetService.Request.REST
        response.success, response.message = self._apply(Reset("rest" if to_rest else "target"))
        return response

    def _load_policy(
        self, request: LoadPolicyService.Request, response: LoadPolicyService.Response
    ) -> LoadPolicyService.Response:
        response.success, response.message = self._apply(LoadPolicy(request.policy))
        return response

    def _select_source(
        self, request: SelectSourceService.Request, response: SelectSourceService.Response
    ) -> SelectSourceService.Response:
        response.success, response.message = self._apply(SelectSource(request.source))
        response.live_sources = self.tracker.live_sources()
        return response

    def _throw_projectile(
        self, request: ThrowProjectileService.Request, response: ThrowProjectileService.Response
    ) -> ThrowProjectileService.Response:
        given = {"mass_kg": request.mass, "radius_m": request.radius, "speed_m_s": request.speed}
        chosen = {name: value for name, value in given.items() if value != 0}
        if request.body:
            chosen["body"] = request.body
        try:
            projectile = Projectile(**chosen, azimuth_rad=request.azimuth, elevation_rad=request.elevation)
            response.success, response.message = self._apply(ThrowProjectile(projectile))
        except UniconError as error:
            response.success, response.message = False, str(error)
        return response

    def _publish_status(self) -> None:
        self._outputs.publish_status(self._status())

    def _status(self) -> ExecutorStatus:
        statistics = self._pacer.statistics()
        tracker = self.tracker
        tick, jitter = statistics.tick_s, statistics.jitter_s
        status = ExecutorStatus(
            mode=int(Mode.PAUSED if self._paused else tracker.mode),
            source=tracker.sources.source,
            live_sources=tracker.live_sources(),
            policy=tracker.policy.name,
            policy_trained=tracker.policy.trained,
            ticks=tracker.ticks,
            missed_ticks=statistics.missed,
            rebases=statistics.rebases,
            rate=statistics.rate_hz,
            real_time_factor=statistics.real_time_factor,
            tick_time_p50=tick.p50,
            tick_time_p99=tick.p99,
            tick_time_max=tick.max,
            jitter_p50=jitter.p50,
            jitter_p99=jitter.p99,
            jitter_max=jitter.max,
            target_age=self._target_age_s(),
            rejected_reasons=[reason.value for reason in tracker.rejected],
            rejected_counts=list(tracker.rejected.values()),
            falls=tracker.falls,
            episode=tracker.episode,
            faults=tracker.faults,
        )
        status.header.stamp = to_stamp(time.time_ns())
        status.header.frame_id = "world"
        return status

    def _publish_diagnostics(self) -> None:
        statistics, tracker = self._pacer.statistics(), self.tracker
        mode = Mode.PAUSED if self._paused else tracker.mode
        slow = statistics.real_time_factor < 0.95 and not (self._paused or self._lockstep)
        troubled = slow or tracker.faults or mode is Mode.FALLEN
        message = "does not keep up with real time" if slow else mode.name.lower()
        self._diagnostics.publish(
            WARN if troubled else OK,
            message,
            {
                "policy": tracker.policy.name,
                "source": tracker.sources.source or "none",
                "ticks": tracker.ticks,
                "missed ticks": statistics.missed,
                "tick time p99 [ms]": f"{1e3 * statistics.tick_s.p99:.2f}",
                "real-time factor": f"{statistics.real_time_factor:.3f}",
                "falls": tracker.falls,
                "physics faults": tracker.faults,
                **{f"rejected: {reason}": count for reason, count in tracker.rejected.items()},
            },
        )


def main() -> int:
    """Run the executor; return the exit status."""
    return run_node(ExecutorNode, "executor_node")
