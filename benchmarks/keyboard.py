"""`make bench-keyboard`: the keyboard scheduler, its reference, and the avatar that follows it.

1. The network and a whole frame of the generator, timed one by one.
2. The scripted drive of two minutes for several seeds: the reference alone, and the avatar in lockstep, which
   is put back into its target when it falls; as the graph runs it, and open loop, with nothing fed back.
3. The node in a graph: its share of a core while it is steered, and the time from a command to the first
   target frame that shows it.

Writes out/bench/keyboard.json, and a video and a contact sheet of the first drive.
"""

from __future__ import annotations

import json
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import tyro
from rich.console import Console
from rich.progress import track

from unicon import state
from unicon.errors import UniconError
from unicon.humanoid import HUMANOID
from unicon.motion.clip_index import RATE_HZ
from unicon.render.gl import NoGLError
from unicon.render.scene import Picture
from unicon.render.show import RenderConfig, render
from unicon.render.take import Take
from unicon.schedulers.keyboard.drive import Stage, command_at, drive_seconds, scripted_drive
from unicon.schedulers.keyboard.drive_metrics import DriveResult, measure_drive
from unicon.schedulers.keyboard.generator import GeneratorConfig, PoseGenerator
from unicon.schedulers.keyboard.scheduler import KeyboardConfig, KeyboardScheduler
from unicon.schedulers.pfnn.network import PhaseNetwork
from unicon.schedulers.pfnn.network_card import PhaseNetworkCard
from unicon.schedulers.pfnn.network_file import find_network, read_network
from unicon.state import CharacterState
from unicon.target_frames import RawFrame, RawTargetFrames
from unicon.tracking import TICK_NS, Tracker, TrackerConfig
from unicon_bringup.graph import GraphConfig, default_list, read_list
from unicon_bringup.session import GraphSession
from unicon_executor.parameters import PARAMETERS as EXECUTOR_PARAMETERS
from unicon_msgs.msg import LocomotionCommand, TargetFrames
from unicon_ros.parameters import Parameter
from unicon_ros.qos import COMMAND, STREAM_SUBSCRIBER
from unicon_schedulers.keyboard_node import PARAMETERS, config_of

_REST_S = 1.5


def defaults(table: Sequence[Parameter]) -> dict[str, object]:
    """Return a node's parameters as they are where nothing is set."""
    return {parameter.name: parameter.default for parameter in table}


@dataclass(frozen=True)
class BenchConfig:
    """What to measure, and where to write."""

    network: str = "pfnn"
    """Name or folder of the network."""
    policy: str = str(defaults(EXECUTOR_PARAMETERS)["policy"])
    """Name or folder of the avatar's policy."""
    seeds: int = 5
    """How many drives."""
    keys: int = 40
    """How many commands are timed."""
    node: bool = True
    """Whether to run the graph."""
    out: Path = Path("out/bench/keyboard.json")


class Drive:
    """One scripted drive: the reference's frames, and how the avatar followed them."""

    def __init__(
        self, card: PhaseNetworkCard, network: PhaseNetwork, policy: str, seed: int, config: KeyboardConfig
    ) -> None:
        self.stages = scripted_drive(seed)
        self.count = round(drive_seconds(self.stages) * RATE_HZ)
        self._scheduler = KeyboardScheduler(network, card, config, 0)
        self._tracker = Tracker(TrackerConfig(policy=policy))

    def run(self) -> tuple[CharacterState, CharacterState, CharacterState, int]:
        """Return reference, avatar and anchored target ``(T,)``, and how often the avatar fell."""
        reference, actual, target = [], [], []
        for tick in range(self.count):
            time_ns = tick * TICK_NS
            self._scheduler.command(command_at(self.stages, tick / RATE_HZ), time_ns)
            window = self._scheduler.next_frames(time_ns)
            count = window.frames.batch_shape[0]
            frames = [RawFrame(**vars(window.frames[k])) for k in range(count)]
            message = RawTargetFrames("keyboard", tick, HUMANOID.id, window.time_ns, 1.0 / RATE_HZ, frames)
            refused = self._tracker.offer(message)
            assert refused is None, refused
            report = self._tracker.tick(time_ns)
            self._scheduler.follow(report.actual, report.target, time_ns + TICK_NS)
            reference.append(window.frames[0])
            actual.append(report.actual)
            target.append(report.target)
        return state.stack(reference), state.stack(actual), state.stack(target), self._tracker.falls


def time_calls(work: Callable[[int], object], count: int) -> np.ndarray:
    """Return how long each call takes [ms], by the clock."""
    times = np.empty(count)
    for index in range(count):
        began = time.perf_counter()
        work(index)
        times[index] = 1e3 * (time.perf_counter() - began)
    return times


def spread(times: np.ndarray) -> dict[str, float]:
    """Return the median and the 99th percentile."""
    return {"p50": float(np.median(times)), "p99": float(np.percentile(times, 99))}


def time_network(network: PhaseNetwork) -> dict[str, dict[str, float]]:
    """Time the network alone and a frame of the generator, along a drive."""
    rng = np.random.default_rng(0)
    inputs = network.input_mean + network.input_std * rng.standard_normal((200, network.sizes[0]))
    predict = time_calls(lambda k: network.predict(inputs[k % 200], 0.01 * k), 5000)
    stages = scripted_drive(0)
    generator = PoseGenerator(network, GeneratorConfig())
    step = time_calls(lambda k: generator.step(command_at(stages, k / RATE_HZ)), 3000)
    return {"predict_ms": spread(predict), "frame_ms": spread(step)}


def graph_config() -> KeyboardConfig:
    """Return how the graph runs the scheduler."""
    listed = next(entry.parameters for entry in read_list(default_list()) if entry.name == "keyboard")
    return config_of(defaults(PARAMETERS) | dict(listed))


def figures(results: list[DriveResult]) -> dict[str, object]:
    """Return the medians over the drives, mean and worst of all their stages, and the stages of the first."""
    stages = [stage for result in results for stage in result.stages]
    velocity = [stage.velocity_error_percent for stage in stages if any(stage.commanded_h)]
    heading = [stage.heading_error_deg for stage in stages]
    return {
        "velocity_error_percent": float(np.median([r.velocity_error_percent for r in results])),
        "velocity_error_percent_mean_worst": (float(np.mean(velocity)), max(velocity)),
        "heading_error_deg": float(np.median([r.heading_error_deg for r in results])),
        "heading_error_deg_mean_worst": (float(np.mean(heading)), max(heading)),
        "foot_slide_cm_s": float(np.median([r.slide_moving_cm_s for r in results])),
        "foot_slide_standing_cm_s": float(np.median([r.slide_standing_cm_s for r in results])),
        "stages": [stage._asdict() for stage in results[0].stages],
    }


class Drives:
    """All drives: the reference alone, and what became of the avatar that followed it."""

    def __init__(self, config: BenchConfig, console: Console) -> None:
        self._config, self._console = config, console
        self._card, self._network = read_network(find_network(config.network))

    def run(self) -> dict[str, object]:
        """Return the figures of the reference and of the avatar, as in the graph and open loop."""
        closed = graph_config()
        opened = replace(closed, feedback=0.0, wait_m=None)
        references, seeds = [], range(self._config.seeds)
        avatars: dict[str, list[DriveResult]] = {"avatar": [], "avatar_open_loop": []}
        falls: dict[str, list[int]] = {name: [] for name in avatars}
        for seed in track(seeds, "drives", console=self._console):
            for name, scheduler in zip(avatars, (closed, opened), strict=True):
                drive = Drive(self._card, self._network, self._config.policy, seed, scheduler)
                reference, actual, target, fell = drive.run()
                avatars[name].append(measure_drive(actual, drive.stages))
                falls[name].append(fell)
                if seed == 0 and name == "avatar":
                    draw(self._config, drive.stages, actual, target, self._console)
            references.append(measure_drive(reference, drive.stages))
        free = [self._slide(seed, replace(opened, foot_lock=None)) for seed in seeds]
        slide = {"foot_slide_free_cm_s": float(np.median(free))}
        found: dict[str, object] = {"reference": {**figures(references), **slide}}
        for name, results in avatars.items():
            counts = {"falls": sum(falls[name]), "falls_of_each_drive": falls[name]}
            found[name] = {**counts, **figures(results)}
        return found

    def _slide(self, seed: int, config: KeyboardConfig) -> float:
        """Return how far feet of the reference slide while it moves [cm/s]."""
        stages = scripted_drive(seed)
        scheduler = KeyboardScheduler(self._network, self._card, config, 0)
        frames = []
        for tick in range(round(drive_seconds(stages) * RATE_HZ)):
            scheduler.command(command_at(stages, tick / RATE_HZ), tick * TICK_NS)
            frames.append(scheduler.next_frames(tick * TICK_NS).frames[0])
        return measure_drive(state.stack(frames), stages).slide_moving_cm_s


def draw(
    config: BenchConfig, stages: list[Stage], actual: CharacterState, target: CharacterState, console: Console
) -> None:
    """Draw the avatar over its target, where this machine can."""
    count = actual.batch_shape[0]
    ends = np.cumsum([stage.seconds for stage in stages])
    names = [
        stages[min(int(np.searchsorted(ends, k / RATE_HZ, "right")), len(stages) - 1)].name
        for k in range(count)
    ]
    take = Take(np.arange(count) / RATE_HZ, actual, target, tuple(names))
    sheet = config.out.with_name("keyboard.png")
    try:
        pictures = Picture(320, 240)
        render(take, RenderConfig(contact_sheet=sheet, picture=pictures, columns=8, rows=6), console)
        small = Picture(480, 270)
        render(take, RenderConfig(video=config.out.with_name("keyboard.mp4"), picture=small), console)
    except NoGLError as error:
        console.print(f"no pictures: {error}")


class NodeBench:
    """Steers the node of a graph and looks at its frames."""

    def __init__(self, session: GraphSession) -> None:
        self._session = session
        self._newest: TargetFrames | None = None
        self._arrived_s = 0.0
        node = session.node
        self._publisher = node.create_publisher(LocomotionCommand, "locomotion_command", COMMAND)
        node.create_subscription(TargetFrames, "target_frames", self._take, STREAM_SUBSCRIBER)

    def _take(self, message: TargetFrames) -> None:
        self._newest, self._arrived_s = message, time.monotonic()

    def key_to_target_ms(self) -> float:
        """Stand, command a walk, and return the time to the first frame that is another."""
        self._session.spin_for(_REST_S)
        assert self._newest is not None
        standing = _numbers(self._newest)
        began = time.monotonic()
        self._publisher.publish(LocomotionCommand(forward=1.2))
        changed = lambda: bool(np.abs(_numbers(self._newest) - standing).max() > 1e-9)  # noqa: E731
        self._session.spin_until(changed, 5.0, "changed target frame")
        return 1e3 * (self._arrived_s - began)

    def drive(self, seconds: float) -> None:
        """Hold the keys of a drive."""
        stages = scripted_drive(0)

        def hold(elapsed: float) -> None:
            command = command_at(stages, elapsed)
            self._publisher.publish(
                LocomotionCommand(
                    forward=command.velocity_h[0], left=command.velocity_h[1], turn_rate=command.turn_rate
                )
            )

        self._session.spin_for(seconds, hold)


def _numbers(message: TargetFrames | None) -> np.ndarray:
    """Return the last frame's place and hinges."""
    assert message is not None
    frame = message.frames[-1]
    return np.array([frame.root_position.x, frame.root_position.y, *frame.joint_positions])


def cpu_seconds(name: str) -> float:
    """Return the processor time of the process whose command line holds a name [s]."""
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = path.read_bytes().split(b"\0")
            fields = path.with_name("stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if any(word.endswith(name.encode()) for word in words[:2]):
            return (int(fields[11]) + int(fields[12])) / 100.0
    raise UniconError(f"there is no process {name}")


def measure_node(config: BenchConfig, folder: Path) -> dict[str, float]:
    """Run the graph; return the node's share of a core and the time from key to target."""
    graph = GraphConfig(avatar="bench", scheduler="keyboard")
    with GraphSession(graph, folder / "graph.log") as session:
        session.wait_until_ready()
        bench = NodeBench(session)
        session.spin_for(_REST_S)
        times = np.array([bench.key_to_target_ms() for _ in range(config.keys)])
        before, began = cpu_seconds("keyboard_node"), time.monotonic()
        bench.drive(30.0)
        used = cpu_seconds("keyboard_node") - before
        percent = 100.0 * used / (time.monotonic() - began)
    return {
        "node_cpu_percent": percent,
        "key_to_target_ms_p50": float(np.median(times)),
        "key_to_target_ms_p99": float(np.percentile(times, 99)),
    }


def main() -> None:
    """Measure and write the figures."""
    config = tyro.cli(BenchConfig, prog="make bench-keyboard", description=__doc__)
    console = Console()
    config.out.parent.mkdir(parents=True, exist_ok=True)
    timed = time_network(read_network(find_network(config.network))[1])
    found: dict[str, object] = {
        "pfnn_ms_p99": timed["predict_ms"]["p99"],
        "pfnn_ms_p50": timed["predict_ms"]["p50"],
        "frame_ms": timed["frame_ms"],
    }
    if config.node:
        with tempfile.TemporaryDirectory() as folder:
            found.update(measure_node(config, Path(folder)))
    found["policy"] = config.policy
    drives = Drives(config, console).run()
    config.out.write_text(json.dumps({**found, **drives}, indent=2) + "\n")
    for name, part in drives.items():
        console.print(name, {key: value for key, value in part.items() if key != "stages"})  # type: ignore[attr-defined]
    console.print(found)
    console.print(str(config.out))


if __name__ == "__main__":
    main()
