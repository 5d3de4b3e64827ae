"""Measurements of this machine for `unicon doctor`: drawing, finding each other, keeping time."""

from __future__ import annotations

import importlib.util
import os
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from unicon.control import ServoControl
from unicon.humanoid import HUMANOID
from unicon.pacing import Percentiles
from unicon.simulation import CONTROL_HZ, SUBSTEPS, Simulation

RATE_HZ = CONTROL_HZ
PHYSICS_HZ = CONTROL_HZ * SUBSTEPS
BACKENDS = ("egl", "osmesa")
DISCOVERY_SCRIPT = Path("tools", "discovery_probe.py")

# A process of its own for each try: MuJoCo chooses its OpenGL when it is imported, and a broken
# driver may end the process.
_DRAW = """
import mujoco
model = mujoco.MjModel.from_xml_string(
    "<mujoco><worldbody><light pos='0 0 3'/><geom size='.5'/></worldbody></mujoco>")
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
with mujoco.Renderer(model, 48, 64) as renderer:
    renderer.update_scene(data)
    raise SystemExit(0 if renderer.render().std() > 0 else 1)
"""


def free_memory_bytes(meminfo: Path = Path("/proc/meminfo")) -> int:
    """Return how much memory a new program can have without swapping."""
    for line in meminfo.read_text().splitlines():
        if line.startswith("MemAvailable:"):
            return int(line.split()[1]) * 1024
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def drawing_backend() -> str | None:
    """Return the OpenGL with which MuJoCo draws off screen, None where there is none."""
    return next((backend for backend in BACKENDS if draws_with(backend)), None)


def draws_with(backend: str) -> bool:
    """Return whether MuJoCo draws a picture that is not all one colour."""
    environment = dict(os.environ, MUJOCO_GL=backend, PYOPENGL_PLATFORM=backend)
    command = [sys.executable, "-c", _DRAW]
    try:
        result = subprocess.run(command, env=environment, capture_output=True, timeout=60)
    except subprocess.TimeoutExpired:
        return False
    return result.returncode == 0


def has_ros() -> bool:
    """Return whether rclpy is installed; it is not imported."""
    return importlib.util.find_spec("rclpy") is not None


def discovery_seconds(script: Path, give_up_after_s: float = 20.0) -> float | None:
    """Let two processes exchange a message; return how long it took [s], None when none came."""
    topic = f"/unicon_doctor_{os.getpid()}"
    speaker = subprocess.Popen(
        [sys.executable, str(script), "say", topic],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        command = [sys.executable, str(script), "listen", topic]
        heard = subprocess.run(command, capture_output=True, text=True, timeout=give_up_after_s)
        return float(heard.stdout) if heard.returncode == 0 else None
    except (subprocess.TimeoutExpired, ValueError):
        return None
    finally:
        _stop(speaker)


def _stop(process: subprocess.Popen) -> None:
    process.terminate()
    try:
        process.wait(timeout=3.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def hears_itself_over_udp(address: str = "127.0.0.1") -> bool:
    """Return whether a datagram sent to this machine's own address arrives."""
    try:
        with (
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver,
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
        ):
            receiver.bind((address, 0))
            receiver.settimeout(1.0)
            sender.sendto(b"hello", receiver.getsockname())
            return receiver.recv(16) == b"hello"
    except OSError:
        return False


def sleep_lateness(duration_s: float) -> Percentiles:
    """Sleep to absolute deadlines at 60 Hz; return how late this process was woken [s]."""
    start = time.monotonic()
    late = np.empty(max(int(duration_s * RATE_HZ), 1))
    for k in range(len(late)):
        deadline = start + (k + 1) / RATE_HZ
        time.sleep(max(deadline - time.monotonic(), 0.0))
        late[k] = time.monotonic() - deadline
    p50, p99 = np.percentile(late, [50, 99])
    return Percentiles(float(p50), float(p99), float(late.max()))


def physics_steps_per_s(ticks: int) -> float:
    """Return how many physics steps of the standing humanoid this machine does in a second."""
    simulation = Simulation()
    rest = HUMANOID.rest_state()
    control = ServoControl(rest.joint_pos, rest.joint_vel)
    simulation.step(control)  # the first one touches memory that the others find warm
    start = time.perf_counter()
    for _ in range(ticks):
        simulation.step(control)
    return ticks * SUBSTEPS / (time.perf_counter() - start)
