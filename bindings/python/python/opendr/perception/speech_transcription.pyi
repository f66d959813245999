"""Learners of the task speech_transcription. Made by bindings/python/stubs.py; do not edit."""

# Each learner has the arguments of OpenDR's class of its name.
# mypy: disable-error-code="override"
# pyright: reportIncompatibleMethodOverride=false

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, Optional, Union, overload

from numpy.typing import ArrayLike, NDArray
from opendr._native_learner import PathLike
from opendr._upstream.learners.sounds import Transcription
from opendr.engine.data import Audio, Timeseries
from opendr.engine.datasets import Dataset
from opendr.engine.target import WhisperTranscription

class WhisperLearner(Transcription):
    """Whisper writes down what was said, with times.

    Task: speech_transcription. ``infer`` takes:

        audio: Audio. What was heard; a Timeseries of one feature is taken to be at the learner's sample rate.

    and gives: WhisperTranscription.

    Args:
        temperature: How random tokens are drawn; the next is tried where the answer to the one before stammers or
            is unlikely. 0 takes the likeliest. (default [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]; 0 to 10; may change while
            running, also for one call of infer)
        compression_ratio_threshold: Text that packs better than this stammers. None: no text does. (default 2.4;
            0 to 1000; may change while running, also for one call of infer)
        logprob_threshold: Tokens whose logarithms of probabilities have a smaller mean are unlikely. None: none
            are. (default -0.8; -1000 to 0; may change while running, also for one call of infer)
        no_speech_threshold: A window that is silent with a higher probability, and whose text is unlikely, has
            none. None: all have. (default 0.6; 0 to 1; may change while running, also for one call of infer)
        condition_on_previous_text: Whether the text of a window is what the next begins with: connected, but
            errors go on too. (default False; may change while running, also for one call of infer)
        language: What is spoken, e.g. `en`. None: multilingual models find out in the first 30 s. (default 'en';
            may change while running, also for one call of infer)
        sample_len: The most tokens of a window. None: 224. (default None; 1 to 448; may change while running,
            also for one call of infer)
        best_of: Texts that are drawn at each temperature above 0, of which the likeliest is taken. None: one.
            (default None; 1 to 64; may change while running, also for one call of infer)
        beam_size: Texts that are followed at temperature 0. None: one, always the likeliest token. (default None;
            1 to 64; may change while running, also for one call of infer)
        patience: So many times as many texts are finished before such a search ends. None: 1. (default None; 0 to
            64; may change while running, also for one call of infer)
        length_penalty: How longer texts are preferred (Google's GNMT), 0 to 1. None: by the mean of their tokens.
            (default None; 0 to 1; may change while running, also for one call of infer)
        initial_prompt: Text that the first window begins behind: names and spellings to be expected. (default
            None; may change while running, also for one call of infer; in OpenDR prompt)
        prefix: Text that every window begins with. (default None; may change while running, also for one call of
            infer)
        suppress_tokens: Numbers of tokens that are never written, separated by commas; -1 stands for signs that
            nobody speaks. None: all may be. (default '-1'; may change while running, also for one call of infer)
        suppress_blank: Whether no window begins with a space or its end. (default True; may change while running,
            also for one call of infer)
        without_timestamps: Whether segments have no times; then there is one for each window. (default False; may
            change while running, also for one call of infer)
        max_initial_timestamp: The latest begin of a window's first segment. None: anywhere. (default 1.0; 0 to 30
            s; may change while running, also for one call of infer)
        partial_interval: How often a stream tells what it understood of a phrase that goes on. None: only phrases
            that are over. (default 3.0; 0.5 to 30 s; may change while running, also for one call of infer)
        silence_level: Sound in a stream whose root mean square is lower is silence. (default 0.002; 0 to 1; may
            change while running, also for one call of infer)
        others: OpenDR's arguments, see ``opendr.engine.learners.BaseLearner``.

    Arguments of OpenDR that are taken and have no effect:
        verbose: no effect: answers are shown by who asks for them.
        word_timestamps: no effect: times are those of segments.
        prepend_punctuations: no effect: it belongs to word_timestamps.
        append_punctuations: no effect: it belongs to word_timestamps.
        fp16: no effect: the runtime computes in 32 bits; weights are stored as the model's file has them.
    """

    temperature: list[Any]
    compression_ratio_threshold: Optional[float]
    logprob_threshold: Optional[float]
    no_speech_threshold: Optional[float]
    condition_on_previous_text: bool
    language: Optional[str]
    sample_len: Optional[int]
    best_of: Optional[int]
    beam_size: Optional[int]
    patience: Optional[float]
    length_penalty: Optional[float]
    initial_prompt: Optional[str]
    prefix: Optional[str]
    suppress_tokens: Optional[str]
    suppress_blank: bool
    without_timestamps: bool
    max_initial_timestamp: Optional[float]
    partial_interval: Optional[float]
    silence_level: float
    def __init__(self, verbose: Any = ..., temperature: list[Any] = ..., compression_ratio_threshold: Optional[float] = ..., logprob_threshold: Optional[float] = ..., no_speech_threshold: Optional[float] = ..., condition_on_previous_text: bool = ..., word_timestamps: Any = ..., prepend_punctuations: Any = ..., append_punctuations: Any = ..., language: Optional[str] = ..., sample_len: Optional[int] = ..., best_of: Optional[int] = ..., beam_size: Optional[int] = ..., patience: Optional[float] = ..., length_penalty: Optional[float] = ..., prompt: Optional[str] = ..., prefix: Optional[str] = ..., suppress_tokens: Optional[str] = ..., suppress_blank: bool = ..., without_timestamps: bool = ..., max_initial_timestamp: Optional[float] = ..., fp16: Any = ..., device: str = ..., *, lr: float = ..., iters: int = ..., batch_size: int = ..., optimizer: str = ..., lr_schedule: str = ..., backbone: str = ..., network_head: str = ..., checkpoint_after_iter: int = ..., checkpoint_load_iter: int = ..., temp_path: str = ..., threshold: float = ..., scale: float = ..., initial_prompt: Optional[str] = ..., partial_interval: Optional[float] = ..., silence_level: float = ...) -> None: ...
    @overload
    def infer(self, audio: Union[Audio, Timeseries], initial_prompt: Optional[str] = ..., *, temperature: list[Any] = ..., compression_ratio_threshold: Optional[float] = ..., logprob_threshold: Optional[float] = ..., no_speech_threshold: Optional[float] = ..., condition_on_previous_text: bool = ..., language: Optional[str] = ..., sample_len: Optional[int] = ..., best_of: Optional[int] = ..., beam_size: Optional[int] = ..., patience: Optional[float] = ..., length_penalty: Optional[float] = ..., prompt: Optional[str] = ..., prefix: Optional[str] = ..., suppress_tokens: Optional[str] = ..., suppress_blank: bool = ..., without_timestamps: bool = ..., max_initial_timestamp: Optional[float] = ..., partial_interval: Optional[float] = ..., silence_level: float = ..., verbose: Any = ..., word_timestamps: Any = ..., prepend_punctuations: Any = ..., append_punctuations: Any = ..., fp16: Any = ...) -> WhisperTranscription: ...
    @overload
    def infer(self, audio: Sequence[Union[Audio, Timeseries]], initial_prompt: Optional[str] = ..., *, temperature: list[Any] = ..., compression_ratio_threshold: Optional[float] = ..., logprob_threshold: Optional[float] = ..., no_speech_threshold: Optional[float] = ..., condition_on_previous_text: bool = ..., language: Optional[str] = ..., sample_len: Optional[int] = ..., best_of: Optional[int] = ..., beam_size: Optional[int] = ..., patience: Optional[float] = ..., length_penalty: Optional[float] = ..., prompt: Optional[str] = ..., prefix: Optional[str] = ..., suppress_tokens: Optional[str] = ..., suppress_blank: bool = ..., without_timestamps: bool = ..., max_initial_timestamp: Optional[float] = ..., partial_interval: Optional[float] = ..., silence_level: float = ..., verbose: Any = ..., word_timestamps: Any = ..., prepend_punctuations: Any = ..., append_punctuations: Any = ..., fp16: Any = ...) -> list[WhisperTranscription]: ...
    @overload
    def infer(self, audio: Iterator[Union[Audio, Timeseries]], initial_prompt: Optional[str] = ..., *, temperature: list[Any] = ..., compression_ratio_threshold: Optional[float] = ..., logprob_threshold: Optional[float] = ..., no_speech_threshold: Optional[float] = ..., condition_on_previous_text: bool = ..., language: Optional[str] = ..., sample_len: Optional[int] = ..., best_of: Optional[int] = ..., beam_size: Optional[int] = ..., patience: Optional[float] = ..., length_penalty: Optional[float] = ..., prompt: Optional[str] = ..., prefix: Optional[str] = ..., suppress_tokens: Optional[str] = ..., suppress_blank: bool = ..., without_timestamps: bool = ..., max_initial_timestamp: Optional[float] = ..., partial_interval: Optional[float] = ..., silence_level: float = ..., verbose: Any = ..., word_timestamps: Any = ..., prepend_punctuations: Any = ..., append_punctuations: Any = ..., fp16: Any = ...) -> Iterator[WhisperTranscription]: ...
    def eval(self, dataset: Dataset, save_path_csv: Any = ..., *, metric: Optional[str] = ..., split: Optional[str] = ..., limit: Optional[int] = ..., out: Optional[PathLike] = ..., skip_broken: bool = ..., classes: Optional[Mapping[str, str]] = ..., by_number: bool = ..., resamples: int = ..., verbose: bool = ..., **metric_params: Any) -> dict[str, Any]: ...
    @classmethod
    def download(cls, name: Any = ..., download_dir: Optional[PathLike] = ..., *, path: Optional[PathLike] = ..., mode: str = ..., verbose: bool = ..., url: Optional[str] = ..., variant: Optional[str] = ...) -> str: ...

class VoskLearner:
    """Not here yet: use WhisperLearner, whose push() takes pieces of sound."""

    def __init__(self, *args: Any, **kwargs: Any) -> NoReturn: ...
