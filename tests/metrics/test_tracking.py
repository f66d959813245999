"""Tracking: py-motmetrics (CLEAR MOT, IDF1) and TrackEval (HOTA, the MOT Challenge's rules)."""

from pathlib import Path

import motmetrics
import numpy as np
import pytest
from motmetrics.distances import boxiou
from trackeval.datasets import MotChallenge2DBox
from trackeval.metrics import HOTA

COUNTS = {
    "frames": "num_frames",
    "objects": "num_objects",
    "predictions": "num_predictions",
    "unique_objects": "num_unique_objects",
    "matches": "num_matches",
    "switches": "num_switches",
    "transfers": "num_transfer",
    "ascends": "num_ascend",
    "migrates": "num_migrate",
    "false_positives": "num_false_positives",
    "misses": "num_misses",
    "fragmentations": "num_fragmentations",
    "mostly_tracked": "mostly_tracked",
    "partially_tracked": "partially_tracked",
    "mostly_lost": "mostly_lost",
}
SHARES = {name: name for name in ["mota", "motp", "precision", "recall"]}
IDENTITY_COUNTS = {name: name for name in ["idtp", "idfp", "idfn"]}
IDENTITY_SHARES = {name: name for name in ["idf1", "idp", "idr"]}
HOTA_FIELDS = {
    "hota": "HOTA",
    "deta": "DetA",
    "assa": "AssA",
    "loca": "LocA",
    "detre": "DetRe",
    "detpr": "DetPr",
    "assre": "AssRe",
    "asspr": "AssPr",
    "owta": "OWTA",
    "true_positives": "HOTA_TP",
    "false_negatives": "HOTA_FN",
    "false_positives": "HOTA_FP",
}

# A row is (id, left, top, width, height, confidence, class); a frame is (rows of ground truth, rows of predictions).


def target(rows):
    names = ["id", "left", "top", "width", "height", "confidence", "name"]
    return {"type": "TrackingAnnotationList", "annotations": [dict(zip(names, row)) for row in rows]}


def case(metric, sequences, parts=1, **params):
    samples = []
    for frames in sequences:
        samples += [{"prediction": target(found), "ground_truth": target(truth)} for truth, found in frames]
        samples[-1]["end_sequence"] = True
    return {"metric": metric, "params": params, "samples": samples, "parts": parts}


def boxes(rows):
    return np.array([row[1:5] for row in rows], dtype=np.float64).reshape(-1, 4)


def overlaps(truth, found):
    return boxiou(boxes(truth)[:, None], boxes(found)[None, :])


def identities(rows):
    return np.array([row[0] for row in rows], dtype=int)


def motmetrics_of(sequences, overlap=0.5):
    accumulators = []
    for frames in sequences:
        accumulator = motmetrics.MOTAccumulator()
        for number, (truth, found) in enumerate(frames):
            distance = 1 - overlaps(truth, found)
            distance[distance > 1 - overlap] = np.nan
            accumulator.update(identities(truth), identities(found), distance, frameid=number)
        accumulators.append(accumulator)
    names = [*COUNTS.values(), *SHARES, *IDENTITY_COUNTS, *IDENTITY_SHARES]
    host = motmetrics.metrics.create()
    table = host.compute_many(accumulators, metrics=names, generate_overall=True)
    return table.loc["OVERALL"].to_dict()


def relabelled(frames):
    """Identities counted from 0, as TrackEval's metrics want them."""
    truth_ids = sorted({row[0] for truth, _ in frames for row in truth})
    found_ids = sorted({row[0] for _, found in frames for row in found})
    return {
        "num_gt_ids": len(truth_ids),
        "num_tracker_ids": len(found_ids),
        "num_gt_dets": sum(len(truth) for truth, _ in frames),
        "num_tracker_dets": sum(len(found) for _, found in frames),
        "gt_ids": [np.array([truth_ids.index(row[0]) for row in truth], dtype=int) for truth, _ in frames],
        "tracker_ids": [np.array([found_ids.index(row[0]) for row in found], dtype=int) for _, found in frames],
        "similarity_scores": [overlaps(truth, found) for truth, found in frames],
    }


def hota_of(sequences):
    metric = HOTA()
    results = {at: metric.eval_sequence(relabelled(frames)) for at, frames in enumerate(sequences)}
    return metric.combine_sequences(results)


def assert_equals_motmetrics(reports, wanted):
    counts, shares = reports
    for report, exact, close in [(counts, COUNTS, SHARES), (shares, IDENTITY_COUNTS, IDENTITY_SHARES)]:
        for key, name in exact.items():
            assert report["scalars"][key] == wanted[name], key
        for key, name in close.items():
            if np.isfinite(wanted[name]):
                assert report["scalars"][key] == pytest.approx(wanted[name], abs=1e-12), key
            else:
                assert key not in report["scalars"]


def assert_equals_trackeval(report, wanted):
    for key, name in HOTA_FIELDS.items():
        assert report["curves"][key] == pytest.approx(list(wanted[name]), abs=1e-6), key
        if key in report["scalars"]:
            assert report["scalars"][key] == pytest.approx(np.mean(wanted[name]), abs=1e-6), key


def random_sequence(seed):
    """A few walkers on a grid (hence ties), with gaps, switches, empty images and false alarms."""
    random = np.random.default_rng(seed)
    walkers = int(random.integers(0, 7))
    place = random.integers(0, 12, size=(walkers, 2)) * 4
    tracks = random.permutation(walkers) + 10
    fresh = 100
    frames = []
    for _ in range(int(random.integers(1, 14))):
        place = place + random.integers(-2, 3, size=place.shape)
        if walkers > 1 and random.random() < 0.3:
            tracks[random.permutation(walkers)[:2]] = tracks[random.permutation(walkers)[:2]]
            tracks = np.array([track if track not in tracks[:at] else -1 for at, track in enumerate(tracks)])
            for at in np.flatnonzero(tracks == -1):
                tracks[at] = fresh = fresh + 1
        truth, found = [], []
        for at in random.permutation(walkers):
            left, top = (int(number) for number in place[at])
            if random.random() < 0.85:
                truth.append((int(at) + 1, left, top, 8, 8, 1, 1))
            if random.random() < 0.8:
                shift = random.integers(-3, 4, size=2) if random.random() < 0.6 else (0, 0)
                found.append((int(tracks[at]), left + int(shift[0]), top + int(shift[1]), 8, 8, 1, 1))
        for _ in range(int(random.integers(0, 3))):
            fresh += 1
            left, top = (int(number) for number in random.integers(0, 48, size=2))
            found.append((fresh, left, top, 8, int(random.integers(4, 12)), 1, 1))
        chance = random.random()
        frames.append(([] if chance < 0.1 else truth, [] if chance > 0.9 else found))
    return frames


def random_sets():
    for seed in range(0, 150, 3):
        yield [random_sequence(seed + at) for at in range(1 + seed % 3)]


def test_random_sequences_as_motmetrics(compute):
    sets = list(random_sets())
    cases = [
        case(metric, sequences, parts=1 + at % 3)
        for at, sequences in enumerate(sets)
        for metric in ["clear_mot", "identity"]
    ]
    reports = compute(*cases)
    for at, sequences in enumerate(sets):
        assert_equals_motmetrics(reports[2 * at : 2 * at + 2], motmetrics_of(sequences))


def test_random_sequences_as_trackeval(compute):
    sets = list(random_sets())
    reports = compute(*(case("hota", sequences, parts=1 + at % 3) for at, sequences in enumerate(sets)))
    for report, sequences in zip(reports, sets):
        assert_equals_trackeval(report, hota_of(sequences))


def real_sequence(name):
    folder = Path(motmetrics.__file__).parent / "data" / name

    def rows(file):
        by_frame = {}
        for line in (folder / file).read_text().split():
            values = [float(value) for value in line.split(",")]
            place = [float(np.float32(value)) for value in values[2:6]]
            by_frame.setdefault(int(values[0]), []).append((int(values[1]), *place, 1, 1))
        return by_frame

    truth, found = rows("gt.txt"), rows("test.txt")
    return [(truth.get(number, []), found.get(number, [])) for number in sorted({*truth, *found})]


@pytest.mark.parametrize("names", [["TUD-Campus"], ["TUD-Stadtmitte"], ["TUD-Campus", "TUD-Stadtmitte"]])
def test_real_sequences(compute, names):
    sequences = [real_sequence(name) for name in names]
    counts, identity, hota = compute(*(case(metric, sequences) for metric in ["clear_mot", "identity", "hota"]))
    assert_equals_motmetrics([counts, identity], motmetrics_of(sequences))
    assert_equals_trackeval(hota, hota_of(sequences))
    assert counts["scalars"]["objects"] > 300


def test_another_threshold(compute):
    sequences = [real_sequence("TUD-Stadtmitte")]
    reports = compute(*(case(metric, sequences, overlap=0.25) for metric in ["clear_mot", "identity"]))
    assert_equals_motmetrics(reports, motmetrics_of(sequences, 0.25))


def challenge_sequence(seed):
    """Ground truth of all classes, some of it marked 0, and predictions near it."""
    random = np.random.default_rng(seed)
    frames = []
    for _ in range(8):
        truth, found = [], []
        for at in range(12):
            left, top = 10 * at + int(random.integers(-1, 2)), int(random.integers(0, 3))
            kind = 1 if at < 4 else int(random.integers(1, 14))
            truth.append((at + 1, left, top, 8, 8, int(random.random() < 0.8), kind))
            if random.random() < 0.8:
                found.append((at + 1, left + int(random.integers(-2, 3)), top, 8, 8, 1, 1))
        frames.append((truth, found))
    return frames


def trackeval_with_rules(frames, benchmark, folder):
    """The data set's own loading, preprocessing and HOTA, from files."""
    sequence = f"{benchmark}-01"
    truth_folder = folder / "gt" / f"{benchmark}-train" / sequence
    found_folder = folder / "trackers" / f"{benchmark}-train" / "tracker" / "data"
    maps = folder / "gt" / "seqmaps"
    for made in [truth_folder / "gt", found_folder, maps]:
        made.mkdir(parents=True)
    (maps / f"{benchmark}-train.txt").write_text(f"name\n{sequence}\n")
    (truth_folder / "seqinfo.ini").write_text(f"[Sequence]\nname={sequence}\nseqLength={len(frames)}\n")

    def text(side):
        lines = []
        for number, rows in enumerate((frame[side] for frame in frames), 1):
            for identity, *place, confidence, kind in rows:
                lines.append(",".join(map(str, [number, identity, *place, confidence, kind, 1])))
        return "\n".join(lines) + "\n"

    (truth_folder / "gt" / "gt.txt").write_text(text(0))
    (found_folder / f"{sequence}.txt").write_text(text(1))
    dataset = MotChallenge2DBox(
        {
            "GT_FOLDER": str(folder / "gt"),
            "TRACKERS_FOLDER": str(folder / "trackers"),
            "BENCHMARK": benchmark,
            "PRINT_CONFIG": False,
        }
    )
    raw = dataset.get_raw_seq_data("tracker", sequence)
    data = dataset.get_preprocessed_seq_data(raw, "pedestrian")
    metric = HOTA()
    return metric.combine_sequences({0: metric.eval_sequence(data)})


@pytest.mark.parametrize("benchmark", ["MOT15", "MOT16", "MOT17", "MOT20"])
@pytest.mark.parametrize("seed", range(4))
def test_rules_of_the_challenge(compute, tmp_path, benchmark, seed):
    frames = challenge_sequence(seed)
    (report, everything) = compute(
        case("hota", [frames], rules=benchmark.lower()),
        case("hota", [frames]),
    )
    assert_equals_trackeval(report, trackeval_with_rules(frames, benchmark, tmp_path))
    assert report["scalars"]["hota"] != everything["scalars"]["hota"]


def test_what_cannot_be_counted_is_an_error(compute):
    row = (1, 0, 0, 8, 8, 1, 1)
    twice, strange = compute(
        case("clear_mot", [[([row, row], [])]]),
        case("hota", [[([(1, 0, 0, 8, 8, 1, 99)], [row])]], rules="mot17"),
    )
    assert "id 1" in twice["error"]
    assert "class 99" in strange["error"]
