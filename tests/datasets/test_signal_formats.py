"""Signals, tracks and clouds: what crates/datasets reads is what the reference tools read, and what it writes they load."""

import csv
import hashlib
import json
import os
import pickle
import re
import subprocess
from pathlib import Path

import cv2
import motmetrics
import numpy as np
import pytest
import soundfile
import trackeval
import wfdb
from aeon import datasets
from scipy.io import wavfile
from programs import example

ROOT = Path(__file__).resolve().parents[2]


class Signals:
    """Reads and writes files, as crates/datasets/examples/signals.rs."""

    def __init__(self):
        self.command = example("datasets", "signals")

    def run(self, *arguments):
        done = subprocess.run([*self.command, *map(str, arguments)], cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout.splitlines()

    def arrays(self, form, path, out, *options):
        """Number and classes of the samples, their names and targets, and their first data."""
        head, *samples = map(json.loads, self.run("arrays", form, path, out, *options))
        return head, samples, [np.load(Path(out) / f"{at:06}_0.npy") for at in range(len(samples))]


@pytest.fixture(scope="session")
def signals():
    return Signals()


@pytest.fixture(scope="session")
def real():
    folder = Path(os.environ.get("OPENDR_TEST_DATA", ROOT.parent / "shared")) / "data"
    if not folder.is_dir():
        pytest.skip("skipped: no OPENDR_TEST_DATA")
    return folder


def tracks(rng, frames=20, objects=5):
    rows = []
    for frame in range(1, frames + 1):
        for number in range(1, objects + 1):
            box = np.round([*rng.uniform(0, 500, 2), *rng.uniform(10, 90, 2)], 2)
            rows.append([frame, number, *box, rng.integers(2), rng.integers(1, 13), round(rng.uniform(), 3)])
    return rows


def write_rows(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(",".join(map(str, row)) + "\n" for row in rows))


def test_mot_truth_is_that_of_motmetrics(signals, tmp_path):
    rows = tracks(np.random.default_rng(1))
    write_rows(tmp_path / "in/train/A/gt/gt.txt", rows)
    wanted = motmetrics.io.loadtxt(tmp_path / "in/train/A/gt/gt.txt", fmt="mot16")
    head, *samples = map(json.loads, signals.run("arrays", "mot", tmp_path / "in", tmp_path / "arrays"))
    found = [track for sample in samples for track in sample["target"]["annotations"]]
    assert head["len"] == 20 and len(found) == len(wanted)
    for track, ((frame, number), row) in zip(sorted(found, key=lambda t: (t["frame"], t["id"])), wanted.sort_index().iterrows()):
        # motmetrics counts pixels from 0, files from 1.
        box = [track["left"] - 1, track["top"] - 1, track["width"], track["height"], track["confidence"]]
        assert (track["frame"], track["id"], track["name"]) == (frame, number, row.ClassId)
        np.testing.assert_allclose(box, [row.X, row.Y, row.Width, row.Height, row.Confidence], atol=1e-4)
    signals.run("convert", "mot", tmp_path / "in", "mot", tmp_path / "out")
    again = motmetrics.io.loadtxt(tmp_path / "out/train/A/gt/gt.txt", fmt="mot16")
    columns = ["X", "Y", "Width", "Height", "Confidence", "ClassId"]
    np.testing.assert_allclose(again[columns], wanted[columns], atol=1e-4)


def test_mot_results_are_loaded_by_motmetrics_and_trackeval(signals, tmp_path):
    rows = tracks(np.random.default_rng(2))
    write_rows(tmp_path / "results.txt", [[*row[:6], 0.5, -1, -1, -1] for row in rows])
    signals.run("results", tmp_path / "results.txt", tmp_path / "trackers/T/data/A.txt")
    loaded = motmetrics.io.loadtxt(tmp_path / "trackers/T/data/A.txt", fmt="mot15-2D")
    assert len(loaded) == len(rows) and (loaded.Confidence == 0.5).all()
    write_rows(tmp_path / "in/A/gt/gt.txt", [[*row[:6], 1, 1, 1] for row in rows])
    signals.run("convert", "mot", tmp_path / "in", "mot", tmp_path / "gt")
    dataset = trackeval.datasets.MotChallenge2DBox({
        "GT_FOLDER": str(tmp_path / "gt/train"), "TRACKERS_FOLDER": str(tmp_path / "trackers"), "SKIP_SPLIT_FOL": True,
        "SEQ_INFO": {"A": None}, "TRACKERS_TO_EVAL": ["T"], "PRINT_CONFIG": False})
    raw = dataset.get_raw_seq_data("T", "A")
    data = dataset.get_preprocessed_seq_data(raw, "pedestrian")
    scores = trackeval.metrics.HOTA().eval_sequence(data)
    assert data["num_gt_dets"] == data["num_tracker_dets"] == len(rows)
    np.testing.assert_allclose(scores["HOTA"], 1)


def test_kitti_is_read_and_written(signals, real, tmp_path):
    root = real / "kitti/object_vis"
    signals.run("convert", "kitti", root, "kitti", tmp_path / "out")
    for at in ["000000", "000001"]:
        scan = np.fromfile(root / f"velodyne/{at}.bin", np.float32)
        assert (np.fromfile(tmp_path / f"out/training/velodyne/{at}.bin", np.float32) == scan).all()
        table = [[(path / f"label_2/{at}.txt").read_text().splitlines()] for path in [root, tmp_path / "out/training"]]
        before, after = [[line.split() for line in lines] for [lines] in table]
        assert [row[0] for row in after] == [row[0] for row in before]
        np.testing.assert_allclose([[float(n) for n in row[1:]] for row in after], [[float(n) for n in row[1:]] for row in before], atol=1e-4)
        matrices = [dict(line.split(":") for line in (path / f"calib/{at}.txt").read_text().splitlines() if line)
                    for path in [root, tmp_path / "out/training"]]
        for name in ["P2", "R0_rect", "Tr_velo_to_cam"]:
            numbers = [np.array(each[name].split(), float) for each in matrices]
            assert (numbers[0] == numbers[1]).all(), name


@pytest.mark.parametrize("subtype", ["PCM_U8", "PCM_16", "PCM_24", "PCM_32", "FLOAT", "DOUBLE", "ULAW", "ALAW"])
@pytest.mark.parametrize("form", ["WAV", "WAVEX"])
def test_wav_is_read_as_soundfile_reads_it(signals, tmp_path, subtype, form):
    sound = np.random.default_rng(3).uniform(-1, 1, (999, 2))
    soundfile.write(tmp_path / "in.wav", sound, 22050, subtype=subtype, format=form)
    signals.run("wav", tmp_path / "in.wav", tmp_path / "out.wav", "Float32")
    wanted, _ = soundfile.read(tmp_path / "in.wav", dtype="float32")
    np.testing.assert_array_equal(np.load(tmp_path / "out.wav.npy"), wanted)


@pytest.mark.parametrize("encoding, scale, offset", [
    ("Pcm8", 128, 128), ("Pcm16", 2**15, 0), ("Pcm24", 2**31, 0), ("Pcm32", 2**31, 0), ("Float32", 1, 0), ("Float64", 1, 0)])
def test_scipy_loads_wav_that_is_written(signals, real, tmp_path, encoding, scale, offset):
    for path in sorted((real / "speech_commands_v0.02_test/yes").glob("*.wav"))[:5]:
        rate, wanted = wavfile.read(path)
        signals.run("wav", path, tmp_path / "out.wav", encoding)
        assert (np.load(tmp_path / "out.wav.npy")[:, 0] == wanted / 32768).all()
        again, found = wavfile.read(tmp_path / "out.wav")
        # Eight bits round to the nearest step, and have none for over 127/128.
        wanted, tolerance = (np.minimum(wanted / 32768, 127 / 128), 1 / 256) if encoding == "Pcm8" else (wanted / 32768, 0)
        assert again == rate
        np.testing.assert_allclose((found.astype(float) - offset) / scale, wanted, rtol=0, atol=tolerance + 1e-9)


def test_speech_parts_are_those_of_the_paper(signals, real, tmp_path):
    root = real / "speech_commands_v0.02_test"
    words = {path.name for path in root.iterdir() if path.is_dir()}
    for name in ["training", "validation", "testing"]:
        def part(file):
            # The paper's rule on the file's own name; clips of unknown words have the word in front of it here.
            speaker = re.sub(r"_nohash_.*$", "", file).rpartition("_")[2]
            digest = hashlib.sha1(speaker.encode()).hexdigest()
            percent = (int(digest, 16) % 2**27) * (100.0 / (2**27 - 1))
            return "validation" if percent < 10 else "testing" if percent < 20 else "training"

        wanted = sorted(f"{word}/{path.name}" for word in words for path in (root / word).glob("*.wav") if part(path.name) == name)
        if wanted:
            head, samples, _ = signals.arrays("speech_commands", root, tmp_path / name, "--split", name)
            assert [sample["name"] for sample in samples] == wanted
            assert head["classes"] == sorted(words)


@pytest.mark.parametrize("kind", "?bBhHiIlLqQefd")
@pytest.mark.parametrize("order", "CF")
def test_npy_both_ways(signals, tmp_path, kind, order):
    array = (np.random.default_rng(4).normal(size=(3, 4, 5)) * 50).astype(kind)
    for shape in [(3, 4, 5), (60,), (1, 60, 1)]:
        wanted = np.array(array.reshape(shape), order=order)
        np.save(tmp_path / "in.npy", wanted if order == "C" else wanted.astype(wanted.dtype.newbyteorder(">")))
        signals.run("npy", tmp_path / "in.npy", tmp_path / "out.npy")
        found = np.load(tmp_path / "out.npy")
        assert found.dtype == np.float32 and (found == wanted.astype(np.float32)).all()


@pytest.mark.parametrize("protocol", [2, 3, 4, 5])
def test_pickled_poses_are_read(signals, tmp_path, protocol):
    rng = np.random.default_rng(5)
    poses = {"pose": [rng.normal(size=(frames, 15, 2)) for frames in [4, 7]], "label": ["wave", "sit"]}
    (tmp_path / "poses.pkl").write_bytes(pickle.dumps(poses, protocol=protocol))
    head, samples, found = signals.arrays("skeleton", tmp_path / "poses.pkl", tmp_path / "arrays")
    assert head == {"len": 2, "classes": ["sit", "wave"]}
    assert [sample["target"]["description"] for sample in samples] == poses["label"]
    for pose, array in zip(poses["pose"], found):
        np.testing.assert_array_equal(array[0, ..., 0], pose.transpose(2, 0, 1).astype(np.float32))
    signals.run("convert", "skeleton", tmp_path / "poses.pkl", "skeleton", tmp_path / "out")
    data, labels = np.load(tmp_path / "out/train_data.npy"), np.load(tmp_path / "out/train_label.npy")
    assert data.shape == (2, 2, 7, 15, 1) and labels.tolist() == [1, 0] and not data[0, :, 4:].any()


def test_real_poses_are_those_of_the_pickle(signals, real, tmp_path):
    path = real / "skeleton/jhmdb_GT_test_1.pkl"
    wanted = pickle.loads(path.read_bytes())
    head, samples, found = signals.arrays("jhmdb", path, tmp_path)
    assert head["len"] == 176 and [sample["target"]["description"] for sample in samples] == list(wanted["label"])
    for pose, array in zip(wanted["pose"], found):
        np.testing.assert_array_equal(array[0, ..., 0], pose.transpose(2, 0, 1).astype(np.float32))


def annotations(lines):
    return [json.loads(line) for line in lines]


@pytest.mark.parametrize("name", ["100", "100_3chan", "03700181", "a103l"])
def test_wfdb_is_read_as_wfdb_reads_it(signals, real, tmp_path, name):
    path = real / "ecg/wfdb" / name
    found = annotations(signals.run("wfdb", path, tmp_path))
    wanted = wfdb.rdrecord(str(path))
    signal = np.load(tmp_path / "signals.npy")
    np.testing.assert_allclose(signal, wanted.p_signal, rtol=1e-5, atol=1e-6)
    again = wfdb.rdrecord(str(tmp_path / name))
    assert (again.fs, again.units, again.sig_name) == (wanted.fs, wanted.units, wanted.sig_name)
    step = np.nanmax(signal, 0) - np.nanmin(signal, 0)
    assert (np.isnan(again.p_signal) == np.isnan(signal)).all()
    assert np.nanmax(np.abs(again.p_signal - signal) / step) < 1 / 65000
    if not path.with_suffix(".atr").exists():
        return
    for where in [path, tmp_path / name]:
        truth = wfdb.rdann(str(where), "atr")
        columns = zip(truth.sample, truth.symbol, truth.subtype, truth.chan, truth.num, truth.aux_note)
        assert [[*map(int, row[:1]), row[1], *map(int, row[2:5]), row[5].rstrip("\0")] for row in columns] == found


@pytest.mark.parametrize("form", ["16", "24", "32", "80", "212"])
def test_wfdb_formats(signals, tmp_path, form):
    steps = {"80": 100, "212": 2000}.get(form, 30000)
    digital = np.random.default_rng(6).integers(-steps, steps, (501, 3))
    wfdb.wrsamp("r", 250, ["mV", "mV", "NU"], ["a", "b b", "c"], d_signal=digital, fmt=[form] * 3, adc_gain=[200, 100.5, 1],
                baseline=[0, 12, -7], write_dir=str(tmp_path))
    times = np.sort(np.random.default_rng(7).choice(501, 60, replace=False))
    kinds = np.random.default_rng(8).choice(list("NLRaVFJASEj/Q~|sT*D\"=pB^t+u?![]en@xf()r"), 60)
    wfdb.wrann("r", "atr", times, symbol=list(kinds), aux_note=["(AFIB" if at % 7 == 0 else "" for at in range(60)], write_dir=str(tmp_path))
    found = annotations(signals.run("wfdb", tmp_path / "r", tmp_path / "out"))
    np.testing.assert_allclose(np.load(tmp_path / "out/signals.npy"), wfdb.rdrecord(str(tmp_path / "r")).p_signal, rtol=1e-5, atol=1e-6)
    assert [row[0] for row in found] == times.tolist() and [row[1] for row in found] == kinds.tolist()
    assert [row[5] for row in found] == ["(AFIB" if at % 7 == 0 else "" for at in range(60)]


@pytest.mark.parametrize("features", [1, 3])
def test_ts_both_ways(signals, tmp_path, features):
    rng = np.random.default_rng(9)
    series = rng.normal(size=(6, features, 11)).astype(np.float32)
    series[2, 0, 3] = np.nan
    lines = [":".join(",".join("?" if np.isnan(n) else repr(float(n)) for n in column) for column in one) for one in series]
    kinds = ["b", "a", "a", "c", "b", "c"]
    head = f"@problemName P\n@timeStamps false\n@missing true\n@univariate {str(features == 1).lower()}\n@dimensions {features}\n@equalLength true\n@seriesLength 11\n@classLabel true c a b\n@data\n"
    (tmp_path / "P_TRAIN.ts").write_text(head + "".join(f"{line}:{kind}\n" for line, kind in zip(lines, kinds)))
    wanted, labels = datasets.load_from_ts_file(str(tmp_path / "P_TRAIN.ts"))
    found, samples, arrays = signals.arrays("ucr", tmp_path / "P_TRAIN.ts", tmp_path / "arrays")
    assert found["classes"] == ["c", "a", "b"] and [sample["target"]["description"] for sample in samples] == list(labels)
    for array, one in zip(arrays, wanted):
        np.testing.assert_array_equal(array.T, one.astype(np.float32))
    signals.run("convert", "ucr", tmp_path / "P_TRAIN.ts", "ucr", tmp_path / "P", "--split", "train")
    again, again_labels = datasets.load_from_ts_file(str(tmp_path / "P/P_TRAIN.ts"))
    np.testing.assert_array_equal(np.array(again, np.float32), np.array(wanted, np.float32))
    assert list(again_labels) == list(labels)


def test_ecg5000_is_what_numpy_reads(signals, real, tmp_path):
    wanted = np.loadtxt(real / "ecg/ECG5000_TRAIN.txt")
    _, samples, arrays = signals.arrays("ucr", real / "ecg/ECG5000_TRAIN.txt", tmp_path)
    assert [int(sample["target"]["description"]) for sample in samples] == wanted[:, 0].astype(int).tolist()
    np.testing.assert_array_equal(np.array(arrays)[..., 0], wanted[:, 1:].astype(np.float32))


def test_pairs_are_those_of_the_table(signals, real, tmp_path):
    head, samples, _ = signals.arrays("lfw", real / "face_verification", tmp_path, "--limit", 40)
    with open(real / "face_verification/master.csv", newline="") as table:
        wanted = list(csv.reader(table))[1:]
    assert head["len"] == len(wanted)
    for sample, (first, second, decision) in zip(samples, wanted):
        assert (sample["name"], sample["target"]["class"]) == (f"{first} {second}", int(decision.strip() == "Yes"))


def test_depth_keeps_its_bits(signals, tmp_path):
    depth = np.random.default_rng(10).integers(0, 65536, (9, 7), np.uint16)
    colour = np.random.default_rng(11).integers(0, 256, (9, 7, 3), np.uint8)
    for kind, picture in [("rgb", colour), ("depth", depth)]:
        (tmp_path / f"in/{kind}/fist").mkdir(parents=True)
        cv2.imwrite(str(tmp_path / f"in/{kind}/fist/a.png"), picture)
    signals.run("convert", "hands", tmp_path / "in", "hands", tmp_path / "out")
    for kind, picture in [("rgb", colour), ("depth", depth)]:
        found = cv2.imread(str(tmp_path / f"out/{kind}/fist/000000.png"), cv2.IMREAD_UNCHANGED)
        assert found.dtype == picture.dtype and (found == picture).all()


@pytest.mark.parametrize("path, form", [
    ("kitti/object_vis", "kitti"), ("speech_commands_v0.02_test", "speech_commands"), ("ecg/wfdb", "wfdb"), ("skeleton", "skeleton"),
    ("ecg/ECG5000_TRAIN.txt", "ucr"), ("face_verification", "lfw")])
def test_real_data_are_recognised(signals, real, path, form):
    assert signals.run("recognise", real / path) == [form]
