"""One table of parameters a node.

Declaration, ranges, error messages and the README's table follow from it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node

from unicon.errors import UniconError


@dataclass(frozen=True)
class Parameter:
    """One parameter. All are read when the node starts and cannot be changed later."""

    name: str
    default: bool | int | float | str | list[str]
    description: str
    unit: str = ""
    minimum: float | None = None
    maximum: float | None = None

    @property
    def range_text(self) -> str:
        """The range in words."""
        if isinstance(self.default, bool):
            return "true or false"
        if self.minimum is None or self.maximum is None:
            return "texts" if isinstance(self.default, list) else "text"
        return f"{self.minimum:g} to {self.maximum:g}"

    def descriptor(self) -> ParameterDescriptor:
        """Return what ROS tools show."""
        unit = f" [{self.unit}]" if self.unit else ""
        descriptor = ParameterDescriptor(
            name=self.name,
            description=self.description + unit,
            additional_constraints=self.range_text,
            read_only=True,
        )
        if self.minimum is not None and self.maximum is not None:
            limits: dict[str, Any] = {"from_value": self.minimum, "to_value": self.maximum}
            if isinstance(self.default, float):
                descriptor.floating_point_range = [FloatingPointRange(**limits)]
            else:
                whole = {key: int(value) for key, value in limits.items()}
                descriptor.integer_range = [IntegerRange(**whole, step=1)]
        return descriptor


def declare_parameters(node: Node, table: Sequence[Parameter]) -> dict[str, Any]:
    """Declare a node's parameters and return their values by name.

    Raises:
        UniconError: when one was given a value of another type or out of its range.
    """
    values = {}
    for parameter in table:
        try:
            declared = node.declare_parameter(
                parameter.name, parameter.default, descriptor=parameter.descriptor()
            )
        except (InvalidParameterTypeException, InvalidParameterValueException) as error:
            given = node._parameter_overrides.get(parameter.name)
            value = given.value if given else "?"
            kind = type(parameter.default).__name__
            raise UniconError(
                f"the parameter {parameter.name} is {value!r}, expected {kind}, {parameter.range_text}"
            ) from error
        values[parameter.name] = declared.value
    return values


def markdown_table(table: Sequence[Parameter]) -> str:
    """Return the table as the package's README shows it."""
    rows = ["| parameter | default | range | description |", "|---|---|---|---|"]
    for p in table:
        default = str(p.default).lower() if isinstance(p.default, bool) else p.default
        shown = f"`{default}`" if default not in ("", []) else "empty"
        unit = f" [{p.unit}]" if p.unit else ""
        rows.append(f"| `{p.name}` | {shown} | {p.range_text} | {p.description}{unit} |")
    return "\n".join(rows) + "\n"
