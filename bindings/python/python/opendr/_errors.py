"""Exceptions: one class per kind of error, each also a subclass of the corresponding exception of Python."""

from __future__ import annotations


class OpenDRError(Exception):
    """Base class of all errors; the message states what is wrong, the values, and what to do."""


class InvalidInput(OpenDRError, ValueError):
    """A datum has a type or a content that a learner does not take."""


class InvalidParam(OpenDRError, ValueError):
    """A parameter is unknown, of another type, or out of range."""


class NotFound(OpenDRError, FileNotFoundError):
    """A file, model, learner or name does not exist, or no model is loaded."""


class IoError(OpenDRError, OSError):
    """Reading or writing failed."""


class NetworkError(OpenDRError, ConnectionError):
    """A server could not be reached, or its response was invalid."""


class IntegrityError(OpenDRError, ValueError):
    """The checksum of a file does not match."""


class FormatError(OpenDRError, ValueError):
    """A file does not conform to its format."""


class Unsupported(OpenDRError, NotImplementedError):
    """A learner, runtime or system does not support this."""


class DeviceError(OpenDRError, RuntimeError):
    """A device is not available; the message lists those that are."""


class InternalError(OpenDRError, RuntimeError):
    """An error in the toolkit, or in a library or learner that it calls."""


#: The class of each kind of error of the native module.
BY_KIND: dict[str, type[OpenDRError]] = {
    **{"InvalidInput": InvalidInput, "InvalidParam": InvalidParam, "NotFound": NotFound, "Io": IoError},
    **{"Network": NetworkError, "Integrity": IntegrityError, "Format": FormatError, "Unsupported": Unsupported},
    **{"Device": DeviceError, "Internal": InternalError},
}
for _class in (OpenDRError, *BY_KIND.values()):
    _class.__module__ = "opendr"
