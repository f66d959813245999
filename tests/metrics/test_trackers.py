"""Our trackers and permissively licensed ones on the same boxes: supervision (MIT) and trackers (Apache-2.0), with their defaults.

The boxes are those that motmetrics has of two videos, without their identities and all of the same confidence.
"""

import json
import subprocess
from pathlib import Path

import motmetrics
import numpy as np
import pytest
import supervision
from test_tracking import case
from trackers import ByteTrackTracker, OCSORTTracker, SORTTracker
from programs import example

ROOT = Path(__file__).resolve().parents[2]
VIDEOS = ["TUD-Campus", "TUD-Stadtmitte"]
#: The references of each of our trackers: what makes one, and the name of its method.
REFERENCES = {
    "sort": [(SORTTracker, "update")],
    "byte_track": [(ByteTrackTracker, "update"), (supervision.ByteTrack, "update_with_detections")],
    "oc_sort": [(OCSORTTracker, "update")],
}


def rows(video, file):
    """Rows `(id, left, top, width, height)` by the number of the frame."""
    by_frame = {}
    for line in (Path(motmetrics.__file__).parent / "data" / video / file).read_text().split():
        values = [float(value) for value in line.split(",")]
        by_frame.setdefault(int(values[0]), []).append((int(values[1]), *values[2:6]))
    return by_frame


def frames_of(video):
    """The ground truth and the detected boxes of each frame."""
    truth, found = rows(video, "gt.txt"), rows(video, "test.txt")
    return [(truth.get(number, []), found.get(number, [])) for number in sorted({*truth, *found})]


def ours(tracker, frames):
    command = example("tracking", "follow")
    lines = "".join(json.dumps([[*row[1:], 1.0] for row in found]) + "\n" for _, found in frames)
    done = subprocess.run([*command, tracker, "{}"], cwd=ROOT, input=lines, stdout=subprocess.PIPE, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()[:-1]]


def reference(make, method, frames):
    tracker, answers = make(), []
    for _, found in frames:
        places = np.array([row[1:] for row in found], dtype=np.float32).reshape(-1, 4)
        corners = np.concatenate([places[:, :2], places[:, :2] + places[:, 2:]], 1)
        ones = np.ones(len(found), dtype=np.float32)
        boxes = supervision.Detections(corners, confidence=ones, class_id=np.zeros(len(found), dtype=int))
        told = getattr(tracker, method)(boxes)
        ids = [] if told.tracker_id is None else told.tracker_id
        pairs = [(int(at), corners) for at, corners in zip(ids, told.xyxy) if at is not None and at >= 0]
        answers.append([(at, x0, y0, x1 - x0, y1 - y0) for at, (x0, y0, x1, y1) in pairs])
    return answers


def scores(compute, frames, answers):
    def rows_of(objects):
        return [(int(row[0]), *map(float, row[1:]), 1, 1) for row in objects]

    sequence = [[(rows_of(truth), rows_of(found)) for (truth, _), found in zip(frames, answers)]]
    identity, hota = compute(case("identity", sequence), case("hota", sequence))
    return identity["scalars"]["idf1"], hota["scalars"]["hota"]


@pytest.mark.parametrize("tracker", REFERENCES)
@pytest.mark.parametrize("video", VIDEOS)
def test_not_below_the_best_reference(compute, tracker, video):
    frames = frames_of(video)
    idf1, hota = scores(compute, frames, ours(tracker, frames))
    others = [scores(compute, frames, reference(*other, frames)) for other in REFERENCES[tracker]]
    print(f"{tracker} on {video}: IDF1 {idf1:.4f}, HOTA {hota:.4f}; references {others}")
    for other_idf1, other_hota in others:
        assert idf1 >= other_idf1 - 1e-9 and hota >= other_hota - 1e-9
    assert idf1 > 0.45
