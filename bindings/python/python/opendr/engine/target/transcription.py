"""What was said."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar

from opendr.engine._checks import text as checked_text
from opendr.engine.target.base_target import Target


class BaseTranscription(Target):
    """What was said; ``data`` is the same as ``text``.

    Args:
        text: The words.

    Raises:
        TypeError: It is no ``str``.
    """

    _fields: ClassVar[tuple[str, ...]] = ("text",)

    def __init__(self, text: str) -> None:
        self.data = text

    @property
    def data(self) -> str:
        """The words."""
        return str(self._data)

    @data.setter
    def data(self, data: str) -> None:
        self._data = checked_text(data, "text")

    @property
    def text(self) -> str:
        """The words."""
        return self.data


class WhisperTranscription(BaseTranscription):
    """What was said, with its parts.

    Args:
        text: The words.
        segments: The parts in the order of time. Each is a dictionary of ``id``, ``seek``, ``start`` and ``end``
            (seconds), ``text``, ``tokens``, ``temperature``, ``avg_logprob``, ``compression_ratio`` and
            ``no_speech_prob``, as Whisper gives it; all may be left out.

    Raises:
        TypeError: The text is no ``str``, or a part no dictionary.
    """

    _fields: ClassVar[tuple[str, ...]] = ("text", "segments")

    def __init__(self, text: str, segments: Iterable[dict[str, Any]] = ()) -> None:
        super().__init__(text)
        self.segments: list[dict[str, Any]] = list(segments)
        for segment in self.segments:
            if not isinstance(segment, dict):
                raise TypeError(f"a segment should be a dictionary, e.g. {{'start': 0.5, ...}}, not {segment!r:.200}")


class VoskTranscription(BaseTranscription):
    """What was said, as a streaming recogniser tells it.

    Args:
        text: The words so far.
        accept_waveform: Whether the phrase is finished: the words will not change any more.

    Raises:
        TypeError: The text is no ``str``.
    """

    _fields: ClassVar[tuple[str, ...]] = ("text", "accept_waveform")

    def __init__(self, text: str, accept_waveform: bool = False) -> None:
        super().__init__(text)
        self.accept_waveform = bool(accept_waveform)
