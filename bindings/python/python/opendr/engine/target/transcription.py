"""Transcriptions of speech."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar

from opendr.engine._checks import text as checked_text
from opendr.engine.target._table import Column, Table, floats, ints, texts
from opendr.engine.target.base_target import Target


class BaseTranscription(Target):
    """A transcription of speech; ``data`` is the same as ``text``.

    Args:
        text: The text.

    Raises:
        TypeError: The text is not a ``str``.
    """

    _fields: ClassVar[tuple[str, ...]] = ("text",)

    def __init__(self, text: str) -> None:
        self.data = text

    @property
    def data(self) -> str:
        """The text."""
        return str(self._data)

    @data.setter
    def data(self, data: str) -> None:
        self._data = checked_text(data, "text")

    @property
    def text(self) -> str:
        """The text."""
        return self.data

    def _table(self) -> Table:
        return {"text": texts([self.text])}


class WhisperTranscription(BaseTranscription):
    """A transcription with its segments.

    Args:
        text: The text.
        segments: The segments in order of time. Each is a dictionary of ``id``, ``seek``, ``start`` and ``end``
            (seconds), ``text``, ``tokens``, ``temperature``, ``avg_logprob``, ``compression_ratio`` and
            ``no_speech_prob``, as of Whisper; all are optional.

    Raises:
        TypeError: The text is not a ``str``, or a segment is not a dictionary.
    """

    _fields: ClassVar[tuple[str, ...]] = ("text", "segments")

    def __init__(self, text: str, segments: Iterable[dict[str, Any]] = ()) -> None:
        super().__init__(text)
        self.segments: list[dict[str, Any]] = list(segments)
        for segment in self.segments:
            if not isinstance(segment, dict):
                raise TypeError(f"a segment should be a dictionary, e.g. {{'start': 0.5, ...}}, not {segment!r:.200}")

    def _table(self) -> Table:
        # A text without segments is one segment of unknown time.
        segments = self.segments or [{"text": self.text}]
        numbers = ("avg_logprob", "compression_ratio", "no_speech_prob", "temperature")
        return {
            "id": ints(segment.get("id") for segment in segments),
            **{name: floats(segment.get(name) for segment in segments) for name in ("start", "end")},
            "text": texts(segment.get("text") for segment in segments),
            **{name: floats(segment.get(name) for segment in segments) for name in numbers},
        }


class VoskTranscription(BaseTranscription):
    """An intermediate or final transcription of a streaming recogniser.

    Args:
        text: The text so far.
        accept_waveform: Whether the phrase is final: its text will not change any more.

    Raises:
        TypeError: The text is not a ``str``.
    """

    _fields: ClassVar[tuple[str, ...]] = ("text", "accept_waveform")

    def __init__(self, text: str, accept_waveform: bool = False) -> None:
        super().__init__(text)
        self.accept_waveform = bool(accept_waveform)

    def _table(self) -> Table:
        return {**super()._table(), "accept_waveform": Column([self.accept_waveform], "bool")}
