"""Transcription of speech."""

import os

from opendr.perception.speech_transcription import WhisperLearner

learner = WhisperLearner(language="en", device="cpu", fp16=False, word_timestamps=False)
learner.download("tiny.en", "./models")
learner.load(name="tiny.en", download_dir="./models")
folder = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/speech_commands_v0.02_test/go")
transcription = learner.infer(os.path.join(folder, sorted(os.listdir(folder))[0]), "a command:")
assert isinstance(transcription.text, str) and transcription.segments is not None
assert str(transcription) == transcription.text
