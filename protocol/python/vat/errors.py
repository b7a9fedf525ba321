"""Errors of the package."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """One fault of an input."""

    code: str
    path: str  #: JSON pointer, such as "/bodies/3/radius"; empty: the whole input
    message: str  #: names the permitted range and the suggestion
    suggestion: str = ""  #: valid name near to the given one, or empty

    def __str__(self) -> str:
        return f"{self.path}: {self.message}" if self.path else self.message


class InputError(ValueError):
    """A scene, body, command, snapshot or frame is invalid. Nothing has changed."""

    def __init__(self, faults: list[tuple[str, str, str, str]]) -> None:
        self.faults = [Fault(*fault) for fault in faults]
        super().__init__("\n".join(map(str, self.faults)))

    @property
    def code(self) -> str:
        """Code of the first fault."""
        return self.faults[0].code


class StepError(ArithmeticError):
    """A step failed also in eight parts, so that the simulation should not continue. The state is
    that at the end of the last complete tick.
    """
