"""Message definitions as bags hold them: a type's own text, then those of all types in it (ros2msg)."""

from __future__ import annotations

import re
from collections.abc import Callable

SEPARATOR = "=" * 80
_FIELD = re.compile(r"^([a-zA-Z_][\w/]*)(<=\d+)?(\[[^\]]*\])?\s+[a-zA-Z_]\w*")
_PRIMITIVES = frozenset(
    "bool byte char float32 float64 int8 uint8 int16 uint16 int32 uint32 int64 uint64 string wstring".split()
)


def short_name(type_name: str) -> str:
    """Return ``package/Type`` of ``package/msg/Type``."""
    package, *_, name = type_name.split("/")
    return f"{package}/{name}"


def nested_types(definition: str, package: str) -> list[str]:
    """Return the message types, as ``package/Type``, that a definition's fields have."""
    found = []
    for line in definition.splitlines():
        match = _FIELD.match(line.strip())
        if match and match[1] not in _PRIMITIVES:
            name = match[1] if "/" in match[1] else f"{package}/{match[1]}"
            found.append(short_name(name))
    return found


def full_definition(type_name: str, definition_of: Callable[[str], str]) -> str:
    """Return the definition of ``package/msg/Type`` with those of all nested types.

    ``definition_of`` returns the text of one type, given as ``package/Type``.
    """
    first = short_name(type_name)
    texts = {first: definition_of(first)}
    waiting = [first]
    while waiting:
        name = waiting.pop(0)
        for nested in nested_types(texts[name], name.split("/")[0]):
            if nested not in texts:
                texts[nested] = definition_of(nested)
                waiting.append(nested)
    parts = [texts.pop(first)]
    parts += [f"{SEPARATOR}\nMSG: {name}\n{text}" for name, text in texts.items()]
    return "\n".join(parts)
