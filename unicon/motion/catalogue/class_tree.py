"""The tree of classes over the clips of a library: from labels such as ``walking/forward``, any depth."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rich.tree import Tree

from unicon.errors import UnknownNameError
from unicon.motion.clip_index import ClipInfo

OTHER = "other"
"""The class of what no rule knows, and of a clip without label."""


@dataclass(frozen=True)
class ClassNode:
    """A class with everything below it."""

    path: str
    """Its place, e.g. walking/forward; empty for the root."""
    own: tuple[int, ...]
    """Rows of the clips that carry exactly this label."""
    children: tuple[ClassNode, ...]
    """In the order of their names."""
    seconds: float
    """Time of all clips in it and below."""

    @property
    def name(self) -> str:
        """The last part of its path."""
        return self.path.rsplit("/", 1)[-1]

    def rows(self) -> tuple[int, ...]:
        """Return the rows of all clips in it and below, rising."""
        return tuple(sorted(row for node in self.walk() for row in node.own))

    def walk(self) -> Iterator[ClassNode]:
        """Yield this node, then all below it, parents before children."""
        yield self
        for child in self.children:
            yield from child.walk()


@dataclass(frozen=True)
class ClassTree:
    """All classes of a list of clips."""

    root: ClassNode

    def node(self, path: str) -> ClassNode:
        """Return the node of a class.

        Raises:
            UnknownNameError: when no clip is in such a class.
        """
        for node in self.root.walk():
            if node.path == path:
                return node
        names = ", ".join(child.name for child in self.root.children)
        raise UnknownNameError(f"no clip is in the class {path!r}; the classes at the top are {names}")


def class_tree(rows: Sequence[ClipInfo]) -> ClassTree:
    """Return the tree of these clips; one without label is in ``other``."""
    labels = [class_parts(info.label) for info in rows]
    return ClassTree(_node("", range(len(rows)), 0, labels, rows))


def class_parts(label: str) -> tuple[str, ...]:
    """Return the names on the way down to a class; empty ones are left out."""
    return tuple(part for part in label.split("/") if part) or (OTHER,)


def top_class(label: str) -> str:
    """Return the first part of a label."""
    return class_parts(label)[0]


def rich_tree(tree: ClassTree, title: str = "all") -> Tree:
    """Return the tree for a terminal, each node with its clips and seconds."""
    return _draw(tree.root, title)


def _node(
    path: str,
    members: Sequence[int],
    depth: int,
    labels: Sequence[tuple[str, ...]],
    infos: Sequence[ClipInfo],
) -> ClassNode:
    own, below = [], {}
    for row in members:
        if len(labels[row]) == depth:
            own.append(row)
        else:
            below.setdefault(labels[row][depth], []).append(row)
    children = tuple(
        _node(f"{path}/{name}".lstrip("/"), below[name], depth + 1, labels, infos) for name in sorted(below)
    )
    seconds = sum(infos[row].seconds for row in own) + sum(child.seconds for child in children)
    return ClassNode(path, tuple(own), children, seconds)


def _draw(node: ClassNode, title: str) -> Tree:
    drawn = Tree(f"{title}  [dim]{_size(len(node.rows()), node.seconds)}[/dim]")
    for child in node.children:
        drawn.add(_draw(child, child.name))
    if node.own and node.children:
        seconds = node.seconds - sum(child.seconds for child in node.children)
        drawn.add(f"[dim]not further divided: {_size(len(node.own), seconds)}[/dim]")
    return drawn


def _size(clips: int, seconds: float) -> str:
    return f"{clips:,} clip{'' if clips == 1 else 's'}, {seconds:,.1f} s"
