"""The project's exceptions. Each names the offending thing and the remedy; the CLI maps each to its exit code."""

from typing import ClassVar, Self


class SfgenError(Exception):
    """A failure that is explained to the user in one line.

    `message` names the thing that is wrong, `remedy` what to do about it.
    """

    exit_code: ClassVar[int] = 1

    def __init__(self, message: str, remedy: str = "") -> None:
        self.message = message
        self.remedy = remedy
        super().__init__(f"{message}; {remedy}" if remedy else message)

    def placed(self, where: str) -> Self:
        """Return the error with the place that it is about in front of its message."""
        self.message = f"{where}: {self.message}"
        self.args = (f"{where}: {self}",)
        return self


class ContentError(SfgenError):
    """Wrong content of a file, a key of params.yaml, or a run that failed (exit code 1)."""


class UsageError(SfgenError):
    """Something wrong in the command line: a missing path, a bad option, an empty prompt (exit code 2)."""

    exit_code = 2


class RefusedError(SfgenError):
    """A well-formed request that cannot be met (exit code 3). `code` names the kind of refusal to programs."""

    exit_code = 3
    code: ClassVar[str] = "refused"
