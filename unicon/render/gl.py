"""Finds an OpenGL that can draw without a screen, before MuJoCo is asked to.

A broken driver may end the process, so each candidate draws a small picture in a process of its own.
"""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from importlib import import_module
from typing import Any

from unicon.errors import UniconError

CANDIDATES = ("egl", "osmesa")
PROBE_TIMEOUT_S = 30
ADVICE = "for pictures and video run `sudo apt install libegl1 libgl1-mesa-dri`"
_PROBE = """
import mujoco
model = mujoco.MjModel.from_xml_string('<mujoco><worldbody><geom size=".1"/></worldbody></mujoco>')
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
renderer = mujoco.Renderer(model, 16, 16)
renderer.update_scene(data)
assert renderer.render().any()
"""


class NoGLError(UniconError):
    """No OpenGL on this machine can draw without a screen."""


def works(candidate: str) -> bool:
    """Return whether a candidate can draw, tried in a process of its own."""
    environment = dict(os.environ, MUJOCO_GL=candidate)
    try:
        result = subprocess.run(
            [sys.executable, "-c", _PROBE],
            env=environment,
            capture_output=True,
            timeout=PROBE_TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return False
    return result.returncode == 0


@cache
def choose_gl() -> str:
    """Return the OpenGL that works; $MUJOCO_GL, where it is set to one of them, is tried first.

    Raises:
        NoGLError: when none works; the message says what to install.
    """
    chosen = os.environ.get("MUJOCO_GL", "")
    for candidate in sorted(CANDIDATES, key=lambda name: name != chosen):
        if works(candidate):
            return candidate
    raise NoGLError(f"neither EGL nor OSMesa works here: {ADVICE}")


def open_context(width: int, height: int) -> Any:
    """Return a current OpenGL context that draws without a screen; it has `free`.

    Raises:
        NoGLError: when none works.
    """
    context = import_module(f"mujoco.{choose_gl()}").GLContext(width, height)
    context.make_current()
    return context
