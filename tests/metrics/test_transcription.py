"""Transcription: jiwer 4."""

import jiwer
import numpy as np
import pytest

WORDS = ["go", "stop", "left", "right", "up", "down", "the", "robot", "one", "two", "naïve", "Übung", "日本", "it's"]


def spoken(text, kind="BaseTranscription"):
    return {"type": kind, "text": text}


def case(pairs, parts=1, **params):
    samples = [{"prediction": spoken(answer), "ground_truth": spoken(truth)} for truth, answer in pairs]
    return {"metric": "transcription", "params": params, "samples": samples, "parts": parts}


def assert_equals_jiwer(report, pairs):
    truths, answers = [truth for truth, _ in pairs], [answer for _, answer in pairs]
    words, characters = jiwer.process_words(truths, answers), jiwer.process_characters(truths, answers)
    found = report["scalars"]
    for key in ["wer", "mer", "wil", "wip"]:
        assert found[key] == pytest.approx(getattr(words, key), abs=1e-9), (key, pairs)
    assert found["cer"] == pytest.approx(characters.cer, abs=1e-9), pairs
    for key in ["hits", "substitutions", "deletions", "insertions"]:
        assert found[f"word_{key}"] == getattr(words, key), (key, pairs)
        assert found[f"character_{key}"] == getattr(characters, key), (key, pairs)


def random_pair(random, vocabulary=WORDS, longest=14):
    truth = list(random.choice(vocabulary, size=int(random.integers(0, longest))))
    answer = []
    for word in truth:
        chance = random.random()
        if chance < 0.1:
            answer.append(random.choice(vocabulary))
        elif chance > 0.2:
            answer += [word] * (1 + (chance > 0.9))
    if random.random() < 0.2:
        answer = list(random.choice(vocabulary, size=int(random.integers(0, longest))))
    spaces = ["", " ", "  ", "\t", " \n "]
    edge = [str(space) for space in random.choice(spaces, size=4)]
    between = " " if random.random() < 0.7 else str(random.choice(["  ", "\t", "\n\n", "\u00a0", "\u2003 "]))
    return edge[0] + between.join(truth) + edge[1], edge[2] + " ".join(answer) + edge[3]


def test_random_corpora(compute):
    corpora = []
    for seed in range(300):
        random = np.random.default_rng(seed)
        corpora.append([random_pair(random) for _ in range(1 + seed % 5)])
    reports = compute(*(case(pairs, parts=1 + at % 3) for at, pairs in enumerate(corpora)))
    for report, pairs in zip(reports, corpora):
        assert_equals_jiwer(report, pairs)


def test_many_alignments_are_equally_short(compute):
    """Few letters: hits depend on which shortest alignment is taken."""
    corpora = []
    for seed in range(300):
        random = np.random.default_rng(seed)
        longest = int(random.choice([6, 40, 200]))
        texts = ["".join(random.choice(list("ab "), size=int(random.integers(0, longest)))) for _ in range(2)]
        corpora.append([tuple(texts)])
    for report, pairs in zip(compute(*map(case, corpora)), corpora):
        assert_equals_jiwer(report, pairs)


@pytest.mark.parametrize("letters", ["abc", "abcdefghijklmnopqrstuvwxyz "])
def test_long_texts(compute, letters):
    """Longer than RapidFuzz takes in one piece."""
    corpora = []
    for seed in range(4):
        random = np.random.default_rng(seed)
        truth = "".join(random.choice(list(letters), size=5000))
        other = "".join(random.choice(list(letters), size=4000 + 700 * seed))
        near = [random.choice(list(letters)) if random.random() < 0.2 else letter for letter in truth]
        gone = [letter for letter in near if random.random() < 0.9]
        longer = list(random.choice(list(letters), size=20000))
        few = longer.copy()
        for place in random.integers(0, 19000, size=20):
            few[place : place + int(random.integers(0, 3))] = random.choice(list(letters), size=1)
        corpora.append([("".join(longer), "".join(few))])
        corpora += [[(truth, other)], [(truth, "".join(near))], [(truth, "".join(gone))], [("".join(gone), truth)]]
    for report, pairs in zip(compute(*map(case, corpora)), corpora):
        assert_equals_jiwer(report, pairs)


@pytest.mark.parametrize(
    "pairs",
    [
        [("", "")],
        [("", "two words")],
        [("two words", "")],
        [("", "word"), ("", "")],
        [("", "word"), ("three words here", "three words")],
        [("a\tb c", "a b c")],
        [("same", "same")],
        [("\x1c a \x1f b", "a b")],
    ],
)
def test_edges(compute, pairs):
    (report,) = compute(case(pairs))
    assert_equals_jiwer(report, pairs)


def test_normalization(compute):
    pairs = [("Hello,  World!", "hello world"), ("It\u2019s\tÜBUNG \u00abnow\u00bb.", "its übung now"), ("a_b (c) $5", "ab c $5")]
    transform = jiwer.Compose(
        [jiwer.ToLowerCase(), jiwer.RemovePunctuation(), jiwer.RemoveWhiteSpace(replace_by_space=True)]
    )
    normalized = [tuple(" ".join(transform(text).split()) for text in pair) for pair in pairs]
    plain, all_of_it = compute(
        case(pairs), case(pairs, lower_case=True, drop_punctuation=True, join_whitespace=True)
    )
    assert_equals_jiwer(plain, pairs)
    assert_equals_jiwer(all_of_it, normalized)
    assert all_of_it["scalars"]["wer"] == 0 < plain["scalars"]["wer"]


@pytest.mark.parametrize("kind", ["VoskTranscription", "WhisperTranscription"])
def test_other_transcriptions(compute, kind):
    sample = {"prediction": spoken(" go left", kind), "ground_truth": spoken("go left now", kind)}
    (report,) = compute({"metric": "transcription", "samples": [sample]})
    assert_equals_jiwer(report, [("go left now", " go left")])


def test_spoken_commands(compute):
    command = {"type": "SpeechCommand", "command": "stop", "confidence": 0.5}
    (report,) = compute({"metric": "transcription", "samples": [{"prediction": command, "ground_truth": spoken("go")}]})
    assert_equals_jiwer(report, [("go", "stop")])
