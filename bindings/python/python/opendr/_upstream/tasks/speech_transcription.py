"""OpenDR's perception.speech_transcription."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "vosk.vosk_learner": {"VoskLearner": Absent("use WhisperLearner, whose push() takes audio in chunks")},
    "whisper.whisper_learner": {"WhisperLearner": HERE},
}

LEARNERS = {
    "WhisperLearner": Learner(
        init="verbose temperature compression_ratio_threshold logprob_threshold no_speech_threshold"
        " condition_on_previous_text word_timestamps prepend_punctuations append_punctuations language sample_len"
        " best_of beam_size patience length_penalty prompt prefix suppress_tokens suppress_blank without_timestamps"
        " max_initial_timestamp fp16 device",
        infer="audio initial_prompt",
        eval="dataset save_path_csv!csv",
        download="name download_dir>path",
        mixin="opendr._upstream.learners.audio:Transcription",
        models="tiny tiny.en base base.en small small.en medium medium.en large",
        folder="whisper_{name=tiny.en}",
        demos="demo",
        differs=(
            "one model, tiny.en, for every `name`; `opendr import` converts others",
            "there are no word timestamps",
        ),
    ),
}
