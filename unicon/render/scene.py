"""The studio: a floor with a grid, soft light, and two humanoids that are only posed, never simulated."""

from __future__ import annotations

from dataclasses import dataclass

from unicon.humanoid.mjcf import Appearance, build_body

TARGET_WHITE = Appearance(
    skin=(0.96, 0.96, 0.97, 1.0), cloth=(0.86, 0.87, 0.89, 1.0), dark=(0.70, 0.72, 0.76, 1.0)
)
AVATAR_YELLOW = Appearance()
DEBUG = Appearance(left=(0.25, 0.5, 0.85, 1.0), right=(0.85, 0.35, 0.25, 1.0))
"""Left blue, right red."""


@dataclass(frozen=True)
class Picture:
    """Size of the pictures in pixels."""

    width: int = 854
    height: int = 480


def translucent(appearance: Appearance, opacity: float) -> Appearance:
    """Return the same colours, seen through."""
    return Appearance(
        *((*colour[:3], opacity) for colour in (appearance.skin, appearance.cloth, appearance.dark))
    )


def build_scene(avatar: Appearance, target: Appearance, picture: Picture) -> str:
    """Return the MJCF of the studio with the bodies ``avatar_...`` and ``target_...``."""
    return f"""<mujoco model="studio">
<compiler angle="radian"/>
<visual>
  <global offwidth="{picture.width}" offheight="{picture.height}" fovy="38"/>
  <headlight ambient="0.42 0.42 0.44" diffuse="0.28 0.28 0.28" specular="0.05 0.05 0.05"/>
  <quality shadowsize="1024" offsamples="2" numslices="16" numstacks="10"/>
  <map znear="0.02" zfar="60" shadowclip="4" fogstart="8" fogend="30"/>
  <rgba haze="0.80 0.84 0.89 1" fog="0.80 0.84 0.89 1"/>
</visual>
<asset>
  <texture name="sky" type="skybox" builtin="gradient" rgb1="0.93 0.95 0.97" rgb2="0.66 0.73 0.81"
    width="256" height="256"/>
  <texture name="grid" type="2d" builtin="checker" rgb1="0.84 0.85 0.87" rgb2="0.79 0.80 0.83"
    mark="edge" markrgb="0.68 0.70 0.74"
    width="512" height="512"/>
  <material name="grid" texture="grid" texrepeat="1 1" texuniform="true"/>
</asset>
<worldbody>
  <light name="key" pos="1.5 -2 4.5" dir="-0.3 0.4 -1" mode="fixed" directional="true"
    diffuse="0.55 0.54 0.52" specular="0.12 0.12 0.12" castshadow="true"/>
  <geom name="floor" type="plane" size="0 0 0.5" material="grid"/>
  {build_body(avatar, "avatar_")}
  {build_body(target, "target_")}
</worldbody>
</mujoco>"""
