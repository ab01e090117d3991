"""Why an operation of Skein has failed, by what its caller can do next."""


class Error(Exception):
    """Everything that Skein fails with; its text gives cause, place and remedy."""


class Unavailable(Error):
    """Not executed: no provider is available. Try later or elsewhere."""


class Overloaded(Error):
    """Not executed: a queue is full. Back off, then try again."""


class Disconnected(Error):
    """The provider died or left; whether the call ran is unknown."""


class TimedOut(Error, TimeoutError):
    """The deadline passed; whether the call ran is unknown."""


class Cancelled(Error):
    """The caller gave up; whether the call ran is unknown."""


class Unimplemented(Error, NotImplementedError):
    """The provider does not know the operation, or this version of it."""


class InvalidArgument(Error, ValueError):
    """The input is invalid; the same input will fail again."""


class Internal(Error):
    """A failure that the interface does not declare."""


class UserException(Error):
    """An exception that IDL declares: a class for each, with its members as attributes."""

    def __str__(self) -> str:
        members = ", ".join(f"{name}={getattr(self, name, None)!r}" for name in getattr(self, "_skein_members", ()))
        return f"{type(self).__qualname__}({members})"


BY_KIND: tuple[type[Error], ...] = (
    Error, Unavailable, Overloaded, Disconnected, TimedOut, Cancelled, Unimplemented, InvalidArgument, Internal, UserException)  # fmt: skip


def kind_of(error: BaseException) -> int:
    """The class of an error on the wire. Exceptions that are not Skein's become Internal."""
    internal = BY_KIND.index(Internal)
    return next((kind for kind, each in enumerate(BY_KIND[:internal]) if kind and isinstance(error, each)), internal)
