"""Writes a rosbag2 folder: one MCAP file and ``metadata.yaml``.

Chunks are small and go to the disk at once, so that a killed process loses half a second at most. Some
space is reserved beforehand: when the disk is full it is given back, and there is room to end the file
properly.
"""

from __future__ import annotations

import errno
import os
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import yaml
from mcap.writer import CompressionType, Writer

from unicon.errors import InputFileError

CHUNK_BYTES = 64 * 1024
FLUSH_PERIOD_S = 0.5
SPARE_BYTES = 4 * 1024 * 1024
METADATA_FILE = "metadata.yaml"
SPARE_FILE = ".spare"
METADATA_VERSION = 9


@dataclass(frozen=True)
class Topic:
    """One topic of a bag."""

    name: str
    type_name: str
    """``package/msg/Type``."""
    definition: str
    """The ros2msg text, nested types included."""
    type_hash: str
    """``RIHS01_...``; empty where unknown."""
    qos_yaml: str
    """The publishers' quality of service, as rosbag2 writes it."""


class _Disk:
    """An unbuffered file that, when the disk is full, gives back the spare space and goes on."""

    def __init__(self, path: Path, spare: Path) -> None:
        self._file = path.open("wb", buffering=0)
        self._spare = spare
        self.full = False
        spare.write_bytes(b"\0" * SPARE_BYTES)

    def write(self, data: bytes) -> int:
        start = self._file.tell()
        try:
            self._write_all(data)
        except OSError as error:
            if error.errno not in (errno.ENOSPC, errno.EDQUOT) or self.full:
                raise
            self.full = True
            self._spare.unlink(missing_ok=True)
            self._file.seek(start)
            self._file.truncate()
            self._write_all(data)
        return len(data)

    def _write_all(self, data: bytes) -> None:
        view = memoryview(data)
        while view:
            written = self._file.write(view)
            view = view[written:]

    def tell(self) -> int:
        return self._file.tell()

    def flush(self) -> None:
        """Nothing is ever held back."""

    def close(self) -> None:
        self._spare.unlink(missing_ok=True)
        self._file.close()


class BagWriter:
    """A bag that is being written.

    Raises:
        InputFileError: when the folder exists already or cannot be made.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        try:
            folder.mkdir(parents=True)
            self._disk = _Disk(folder / f"{folder.name}_0.mcap", folder / SPARE_FILE)
        except FileExistsError as error:
            raise InputFileError(
                f"{folder}: exists already; choose another folder for the recording"
            ) from error
        except OSError as error:
            raise InputFileError(f"{folder}: cannot be made ({os.strerror(error.errno or 0)})") from error
        self._writer = Writer(self._disk, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)  # type: ignore[arg-type]
        self._writer.start(profile="ros2", library="unicon")
        self._topics: dict[str, tuple[Topic, int]] = {}
        self._schemas: dict[str, int] = {}
        self.counts: Counter[str] = Counter()
        self._first_ns: int | None = None
        self._last_ns = 0
        self._flushed_s = time.monotonic()
        self.closed = False

    @property
    def full(self) -> bool:
        """Whether the disk is full: nothing more should be written, only `close` called."""
        return self._disk.full

    def add_topic(self, topic: Topic) -> None:
        """Announce a topic before its first message."""
        if topic.type_name not in self._schemas:
            text = topic.definition.encode()
            self._schemas[topic.type_name] = self._writer.register_schema(topic.type_name, "ros2msg", text)
        channel = self._writer.register_channel(
            topic.name,
            "cdr",
            self._schemas[topic.type_name],
            {"offered_qos_profiles": topic.qos_yaml, "topic_type_hash": topic.type_hash},
        )
        self._topics[topic.name] = (topic, channel)

    def write(self, topic: str, data: bytes, log_ns: int, publish_ns: int) -> None:
        """Append a serialised message as it came."""
        _, channel = self._topics[topic]
        self._writer.add_message(channel, log_ns, data, publish_ns, self.counts[topic])
        self.counts[topic] += 1
        self._first_ns = log_ns if self._first_ns is None else min(self._first_ns, log_ns)
        self._last_ns = max(self._last_ns, log_ns)

    def flush_when_due(self) -> None:
        """Bring what is held back to the disk, every half second."""
        if time.monotonic() - self._flushed_s >= FLUSH_PERIOD_S:
            self._writer.flush()
            self._flushed_s = time.monotonic()

    def close(self, custom_data: Mapping[str, str] | None = None) -> None:
        """End the file and write the metadata."""
        if self.closed:
            return
        self.closed = True
        self._writer.finish()
        self._disk.close()
        topics = [(topic, self.counts[name]) for name, (topic, _) in self._topics.items()]
        write_metadata(self.folder, topics, self._first_ns or 0, self._last_ns, custom_data)


class _PlainDumper(yaml.SafeDumper):
    """Writes equal parts out instead of referring to the first one."""

    def ignore_aliases(self, data: object) -> bool:
        return True


def write_metadata(
    folder: Path,
    topics: list[tuple[Topic, int]],
    first_ns: int,
    last_ns: int,
    custom_data: Mapping[str, str] | None = None,
) -> None:
    """Write ``metadata.yaml`` as rosbag2 does; ``topics`` come with their numbers of messages."""
    total = sum(count for _, count in topics)
    span = {
        "duration": {"nanoseconds": max(last_ns - first_ns, 0)},
        "starting_time": {"nanoseconds_since_epoch": first_ns},
        "message_count": total,
    }
    file = f"{folder.name}_0.mcap"
    content = {
        "version": METADATA_VERSION,
        "storage_identifier": "mcap",
        **span,
        "topics_with_message_count": [_topic_entry(topic, count) for topic, count in topics],
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [file],
        "files": [{"path": file, **span}],
        "custom_data": dict(custom_data or {}),
        "ros_distro": "jazzy",
    }
    text = yaml.dump({"rosbag2_bagfile_information": content}, Dumper=_PlainDumper, sort_keys=False)
    (folder / METADATA_FILE).write_text(text)


def _topic_entry(topic: Topic, count: int) -> dict[str, object]:
    return {
        "topic_metadata": {
            "name": topic.name,
            "type": topic.type_name,
            "serialization_format": "cdr",
            "offered_qos_profiles": yaml.safe_load(topic.qos_yaml) or [],
            "type_description_hash": topic.type_hash,
        },
        "message_count": count,
    }
