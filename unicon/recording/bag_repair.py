"""Mends a bag whose writer was killed: keeps every whole chunk and writes the index and metadata anew."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from mcap.exceptions import McapError
from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader

from unicon.errors import InputFileError
from unicon.recording.bag_writer import METADATA_FILE, SPARE_FILE, BagWriter, Topic


class Repaired(NamedTuple):
    """What a repair found."""

    messages: int
    seconds: float
    kept: Path
    """The damaged file, as it was."""


def repair_bag(folder: Path) -> Repaired:
    """Mend a bag in its place; the damaged file stays beside it, as ``*.broken``.

    Raises:
        InputFileError: when there is no bag, it needs no repair, or nothing of it can be read.
    """
    damaged = _damaged_file(folder)
    scratch = folder / "repaired" / folder.name
    writer = BagWriter(scratch)
    times_ns = _copy(damaged, writer)
    writer.close({"repaired": "true"})
    if not times_ns:
        _remove(scratch)
        raise InputFileError(f"{damaged}: not one whole chunk can be read; there is nothing to mend")
    kept = damaged.with_suffix(".mcap.broken")
    damaged.rename(kept)
    (scratch / damaged.name).rename(damaged)
    (scratch / METADATA_FILE).rename(folder / METADATA_FILE)
    _remove(scratch)
    (folder / SPARE_FILE).unlink(missing_ok=True)
    return Repaired(len(times_ns), (max(times_ns) - min(times_ns)) / 1e9, kept)


def _remove(scratch: Path) -> None:
    for path in scratch.iterdir():
        path.unlink()
    scratch.rmdir()
    scratch.parent.rmdir()


def _damaged_file(folder: Path) -> Path:
    if not folder.is_dir():
        raise InputFileError(f"{folder}: there is no such bag; give the folder of a recording")
    path = folder / f"{folder.name}_0.mcap"
    if not path.exists():
        raise InputFileError(f"{folder}: holds no {path.name}; is it the folder of a recording?")
    if (folder / METADATA_FILE).exists():
        raise InputFileError(f"{folder}: has its {METADATA_FILE}; it is whole and needs no repair")
    return path


def _copy(damaged: Path, writer: BagWriter) -> list[int]:
    """Copy whatever can be read; return the log times."""
    schemas: dict[int, Schema] = {}
    channels: dict[int, str] = {}
    times_ns: list[int] = []
    with damaged.open("rb") as file:
        try:
            for record in StreamReader(file).records:
                if isinstance(record, Schema):
                    schemas[record.id] = record
                elif isinstance(record, Channel) and record.id not in channels:
                    channels[record.id] = record.topic
                    writer.add_topic(_topic(record, schemas[record.schema_id]))
                elif isinstance(record, Message):
                    topic = channels[record.channel_id]
                    writer.write(topic, record.data, record.log_time, record.publish_time)
                    times_ns.append(record.log_time)
        except (McapError, EOFError, ValueError, KeyError, OverflowError):
            return times_ns  # the torn end: everything before it is kept
        except Exception as error:  # the decompressors raise types of their own on a torn chunk
            if "zstd" not in type(error).__module__ and "struct" not in type(error).__module__:
                raise
    return times_ns


def _topic(channel: Channel, schema: Schema) -> Topic:
    return Topic(
        name=channel.topic,
        type_name=schema.name,
        definition=schema.data.decode(),
        type_hash=channel.metadata.get("topic_type_hash", ""),
        qos_yaml=channel.metadata.get("offered_qos_profiles", "[]"),
    )
