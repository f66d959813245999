"""The exceptions: one class for each kind of error, also a subclass of Python's own nearest."""

from __future__ import annotations


class OpenDRError(Exception):
    """Whatever went wrong; the text says what, the values, and what to do next."""


class InvalidInput(OpenDRError, ValueError):
    """A datum, or what stands in it, is not what a learner takes."""


class InvalidParam(OpenDRError, ValueError):
    """A parameter is unknown, of another type, or out of range."""


class NotFound(OpenDRError, FileNotFoundError):
    """A file, model, learner or name is not there, or nothing is loaded yet."""


class IoError(OpenDRError, OSError):
    """The system could not read or write."""


class NetworkError(OpenDRError, ConnectionError):
    """A server could not be reached, or did not answer as it should."""


class IntegrityError(OpenDRError, ValueError):
    """A file is not the one that its checksum says."""


class FormatError(OpenDRError, ValueError):
    """A file is not of its format."""


class Unsupported(OpenDRError, NotImplementedError):
    """A learner, runtime or system cannot do this."""


class DeviceError(OpenDRError, RuntimeError):
    """A device is not there; the text lists those that are."""


class InternalError(OpenDRError, RuntimeError):
    """A fault of the toolkit, or of a library or learner that it calls."""


#: The class of each kind of error in the native half.
BY_KIND: dict[str, type[OpenDRError]] = {
    **{"InvalidInput": InvalidInput, "InvalidParam": InvalidParam, "NotFound": NotFound, "Io": IoError},
    **{"Network": NetworkError, "Integrity": IntegrityError, "Format": FormatError, "Unsupported": Unsupported},
    **{"Device": DeviceError, "Internal": InternalError},
}
for _class in (OpenDRError, *BY_KIND.values()):
    _class.__module__ = "opendr"
