"""Which performance a file holds, so that copies of it never end on both sides of a split.

Formats, mirrored copies, trims, cleaned versions and the two partners of one dance share a take.
"""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from unicon.motion.catalogue.by_hand import by_hand
from unicon.motion.catalogue.cmu_index import cmu_index, cmu_take
from unicon.motion.catalogue.provenance import provenance_of

_PREFIX = re.compile(r"^(humanoid3d_|pybullet_walker_)", re.IGNORECASE)
_SUFFIX = re.compile(r"[_~-](mirror(ed)?|flip(ped)?|rm|inplace|in_place|poses|copy)$", re.IGNORECASE)


def take_of(origin: str) -> str:
    """Return the identity of the performance, e.g. ``cmu/07_01``.

    Args:
        origin: the file's path, or ``archive.zip/inner/path.bvh``.
    """
    key = key_of(origin)
    cmu = cmu_take(PurePosixPath(origin).stem)
    if cmu is not None:
        subject = by_hand().partners.get(cmu.subject, cmu.subject)
        partner = cmu_index().get((subject, cmu.trial))
        key = f"cmu/{partner.name}" if partner is not None else key
    return by_hand().takes.get(key, key)


def key_of(origin: str) -> str:
    """Return ``collection/name`` of a file, without what its name says of format and copy."""
    path = PurePosixPath(origin.replace("\\", "/"))
    cmu = cmu_take(path.stem)
    if cmu is not None:
        return f"cmu/{cmu.name}"
    return f"{provenance_of(origin).collection}/{plain_name(path.stem).lower()}"


def plain_name(stem: str) -> str:
    """Return a file's name without what it says of format and copy."""
    name, before = _PREFIX.sub("", stem), ""
    while name != before:
        before, name = name, _SUFFIX.sub("", name)
    return name
