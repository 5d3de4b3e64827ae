"""Clusters: which clips a specialist learns, and the file that says so.

Clips are put together by the class tree. A class with few enough clips is a cluster; of one with more, each
class below it is, and those too small for that are put together. What is still too large, and cannot be
divided by class, is cut by length: clips of like lengths stay together. It depends on the clips alone, not
on their order.

``clusters.yaml`` keeps it: clips that come later get clusters of their own, and none changes.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil
from pathlib import Path

import yaml

from unicon.errors import InputFileError
from unicon.motion.catalogue.class_tree import ClassNode, class_tree
from unicon.motion.clip_index import ClipInfo
from unicon.train.runs.settings import build, plain
from unicon.train.runs.state_file import write_in_one_step

CLUSTERS_FILE = "clusters.yaml"
GENERALIST = "generalist"


@dataclass(frozen=True)
class Cluster:
    """The clips of a specialist."""

    name: str
    """Of its folder."""
    clips: tuple[str, ...]
    """By name."""
    round: int = 1
    """In which it is trained."""
    begins_from: str = GENERALIST
    """The stage whose networks it begins with."""
    single: bool = False
    """Whether it is for a clip that another specialist did not master."""

    @property
    def stage(self) -> str:
        """Return its name among the stages, which is its folder in that of the whole training."""
        return f"specialists/{self.name}"


@dataclass(frozen=True)
class _File:
    clusters: tuple[Cluster, ...] = ()
    version: int = 1


def make_clusters(
    infos: Sequence[ClipInfo], max_clips: int, min_clips: int, taken: Collection[str] = (), number: int = 1
) -> list[Cluster]:
    """Return clusters of all these clips.

    Args:
        infos: the clips.
        max_clips: of a cluster.
        min_clips: classes with fewer are put together.
        taken: names that are in use.
        number: of the round in which they are trained.
    """
    infos = sorted(infos, key=lambda info: info.name)
    names: set[str] = set(taken)
    clusters: list[Cluster] = []
    if not infos:
        return clusters
    for path, rows in _groups(class_tree(infos).root, max_clips, min_clips):
        for part in _cut([infos[row] for row in rows], max_clips):
            name = _free_name(folder_name(path or "all"), names)
            names.add(name)
            clusters.append(Cluster(name, tuple(info.name for info in part), number))
    return clusters


def single_cluster(clip: str, begins_from: str, number: int) -> Cluster:
    """Return the cluster of one clip in a round."""
    suffix = "" if number == 1 else f"-{number}"
    return Cluster(f"single-{folder_name(clip)}{suffix}", (clip,), number, begins_from, single=True)


def folder_name(text: str) -> str:
    """Return a class path or a clip's name as the name of a folder."""
    return re.sub(r"[^A-Za-z0-9_.#]+", "-", text).strip("-.") or "clip"


def write_clusters(folder: Path, clusters: Iterable[Cluster]) -> None:
    """Write ``clusters.yaml``.

    Raises:
        UniconError: when it cannot be written.
    """
    text = yaml.safe_dump(plain(_File(tuple(clusters))), sort_keys=False, default_flow_style=None, width=110)
    write_in_one_step(folder / CLUSTERS_FILE, text)


def read_clusters(folder: Path) -> list[Cluster]:
    """Return the clusters of a training; none where there is no file yet.

    Raises:
        InputFileError: when the file says something else than it should.
    """
    path = folder / CLUSTERS_FILE
    if not path.is_file():
        return []
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise InputFileError(f"{path}: cannot be read ({' '.join(str(error).split())})") from error
    return list(build(_File, values, str(path)).clusters)


def clusters_of(clusters: Iterable[Cluster]) -> Mapping[str, list[Cluster]]:
    """Return for each clip the clusters that hold it, in their order."""
    found: dict[str, list[Cluster]] = {}
    for cluster in clusters:
        for clip in cluster.clips:
            found.setdefault(clip, []).append(cluster)
    return found


def _groups(node: ClassNode, most: int, least: int) -> Iterator[tuple[str, list[int]]]:
    """Yield paths and rows; the top classes are never put together."""
    top = node.path == ""
    if not node.children or (not top and len(node.rows()) <= most):
        yield node.path, list(node.rows())
        return
    rest = list(node.own)
    for child in node.children:
        if top or len(child.rows()) >= least:
            yield from _groups(child, most, least)
        else:
            rest += child.rows()
    if rest:
        yield node.path, rest


def _cut(infos: Sequence[ClipInfo], most: int) -> list[list[ClipInfo]]:
    """Return parts of nearly the same size, the shortest clips first."""
    by_length = sorted(infos, key=lambda info: (info.frames, info.name))
    count = ceil(len(by_length) / most)
    bounds = [round(len(by_length) * part / count) for part in range(count + 1)]
    return [by_length[a:b] for a, b in zip(bounds, bounds[1:], strict=False)]


def _free_name(name: str, taken: Collection[str]) -> str:
    number = 1
    while (numbered := name if number == 1 else f"{name}-{number}") in taken:
        number += 1
    return numbered
