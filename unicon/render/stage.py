"""Draws single frames of a take."""

from __future__ import annotations

from types import TracebackType
from typing import Literal, Self

import mujoco
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from unicon.render.camera import CameraConfig, look_at
from unicon.render.gl import open_context
from unicon.render.scene import AVATAR_YELLOW, TARGET_WHITE, Picture, build_scene, translucent
from unicon.render.take import Take
from unicon.state import CharacterState

Layout = Literal["overlay", "side_by_side"]

GHOST_OPACITY = 0.5
APART_M = 1.3
FAR_AWAY_M = -50.0
QPOS_SIZE = 42
MAX_GEOMS = 1000


class Stage:
    """A studio for one take; a context manager.

    Raises:
        NoGLError: when nothing on this machine can draw.
    """

    def __init__(self, take: Take, picture: Picture, camera: CameraConfig, layout: Layout) -> None:
        self._take, self._layout = take, layout
        ghost = translucent(TARGET_WHITE, GHOST_OPACITY) if layout == "overlay" else TARGET_WHITE
        self._model = mujoco.MjModel.from_xml_string(build_scene(AVATAR_YELLOW, ghost, picture))
        self._data = mujoco.MjData(self._model)
        self._gl = open_context(picture.width, picture.height)
        self._context = mujoco.MjrContext(self._model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._scene = mujoco.MjvScene(self._model, maxgeom=MAX_GEOMS)
        self._area = mujoco.MjrRect(0, 0, picture.width, picture.height)
        self._camera = mujoco.MjvCamera()
        self._camera.azimuth, self._camera.elevation = camera.azimuth_deg, camera.elevation_deg
        self._camera.distance = camera.distance_m
        self._points = look_at(take, camera)
        self._font = ImageFont.load_default(max(picture.height // 26, 10))
        turn = np.radians(camera.azimuth_deg)
        self._sideways = 0.5 * APART_M * np.array([np.sin(turn), -np.cos(turn), 0.0])

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._context.free()
        self._gl.free()

    def draw(self, frame: int, with_caption: bool = True) -> np.ndarray:
        """Return one frame ``(height, width, 3)`` uint8."""
        self._pose(frame)
        self._camera.lookat[:] = self._points[frame]
        everything = mujoco.mjtCatBit.mjCAT_ALL
        option = mujoco.MjvOption()
        mujoco.mjv_updateScene(self._model, self._data, option, None, self._camera, everything, self._scene)
        picture = np.empty((self._area.height, self._area.width, 3), np.uint8)
        mujoco.mjr_render(self._area, self._scene, self._context)
        mujoco.mjr_readPixels(picture, None, self._area, self._context)
        picture = np.flipud(picture)
        return self._caption(picture, frame) if with_caption else picture

    def _pose(self, frame: int) -> None:
        apart = self._layout == "side_by_side" and self._take.target is not None
        offset = self._sideways if apart else np.zeros(3)
        self._write(0, self._take.avatar[frame], offset)
        if self._take.target is None:
            self._data.qpos[QPOS_SIZE + 2] = FAR_AWAY_M
        else:
            self._write(1, self._take.target[frame], -offset)
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_camlight(self._model, self._data)

    def _write(self, humanoid: int, state: CharacterState, offset_w: np.ndarray) -> None:
        start = humanoid * QPOS_SIZE
        self._data.qpos[start : start + QPOS_SIZE] = state.to_mujoco()[0]
        self._data.qpos[start : start + 3] += offset_w

    def _caption(self, picture: np.ndarray, frame: int) -> np.ndarray:
        image = Image.fromarray(picture)
        text = f"{self._take.times_s[frame]:6.2f} s   {self._take.captions[frame]}"
        margin = self._font.size // 2  # type: ignore[union-attr]
        ImageDraw.Draw(image).text((margin, margin), text, fill=(60, 66, 76), font=self._font)
        return np.asarray(image)
