"""`opendr eval`, `score` and `data`, compared with pycocotools."""

import contextlib
import io
import json
import shutil
import signal
import subprocess
import xml.etree.ElementTree as ElementTree

import cv2
import numpy as np
import pytest
from coco128 import Coco128
from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval

NUMBERS = ["map", "map50", "map75", "map_small", "map_medium", "map_large"]
NUMBERS += ["mar1", "mar10", "mar", "mar_small", "mar_medium", "mar_large"]


def done(process):
    assert process.returncode == 0, process.stderr
    return process.stdout


@pytest.fixture(scope="module")
def coco128(shared):
    return shared / "data/coco128"


@pytest.fixture(scope="module")
def evaluated(opendr, coco128, tmp_path_factory):
    """The outcome of CenterNet on all images, and the folder that it was written into."""
    folder = tmp_path_factory.mktemp("evaluated")
    return json.loads(done(opendr.run("eval", "centernet", coco128, "--out", folder, "--json", "--quiet"))), folder


def pycocotools(truth, results, kind="bbox"):
    with contextlib.redirect_stdout(io.StringIO()):
        truth = COCO(str(truth))
        evaluation = COCOeval(truth, truth.loadRes(results), kind)
        evaluation.evaluate()
        evaluation.accumulate()
        evaluation.summarize()
    return evaluation.stats


def test_eval_gives_pycocotools_numbers(coco128, evaluated):
    outcome, folder = evaluated
    coco = Coco128(coco128)
    assert (outcome["samples"], outcome["counted"], outcome["complete"]) == (len(coco.pictures), len(coco.pictures), True)
    _, *lines = (json.loads(line) for line in (folder / "predictions.jsonl").read_text().splitlines())
    paths = {path.name: str(path) for path in coco.pictures}
    named = [
        {"input": paths[line["name"].rsplit("/", 1)[-1]], "outputs": {"boxes": line["prediction"]}} for line in lines
    ]
    assert outcome["scalars"]["map50"] == pytest.approx(coco.map50(named), abs=1e-6)
    assert outcome["scalars"]["map50"] > 0.5
    assert json.loads((folder / "report.json").read_text())["scalars"] == outcome["scalars"]
    assert (folder / "precision_recall.svg").read_text().startswith("<svg")
    # 24 samples, each with ground truth and prediction, six images per row.
    lowest, evenly = (cv2.imread(str(folder / name)) for name in ["lowest_scores.png", "samples.png"])
    assert lowest.shape == evenly.shape and (lowest != evenly).any()


def test_answers_are_ranked_below_the_threshold_of_the_card(opendr, coco128):
    card = opendr.run("eval", "single_shot_detector", coco128, "--limit", "3")
    assert done(card) and "threshold 0.01 instead of 0.3" in card.stderr
    asked = opendr.run("eval", "single_shot_detector", coco128, "--limit", "3", "--threshold", "0.5")
    assert done(asked) and "instead of" not in asked.stderr


def test_broken_off_evaluation_goes_on(opendr, coco128, evaluated, tmp_path):
    environment = {**opendr.environment, "OPENDR_THREADS": "1"}
    command = [opendr.binary, "eval", "centernet", str(coco128), "--out", str(tmp_path)]
    running = subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    journal = tmp_path / "predictions.jsonl"
    while running.poll() is None and (not journal.is_file() or journal.read_bytes().count(b"\n") < 5):
        pass
    running.send_signal(signal.SIGINT)
    output, _ = running.communicate()
    assert running.returncode == 130
    assert "not complete" in output
    before = journal.read_bytes()
    again = opendr.run(*command[1:])
    assert "resuming after" in again.stderr
    assert journal.read_bytes().startswith(before)
    scalars = json.loads((tmp_path / "report.json").read_text())["scalars"]
    assert scalars["map50"] == pytest.approx(evaluated[0]["scalars"]["map50"], abs=0.02)
    other = opendr.run("eval", "nanodet", coco128, "--out", tmp_path)
    assert other.returncode == 11 and "another evaluation (learner differs" in other.stderr


def test_results_files_are_scored_as_pycocotools_does(opendr, coco128, evaluated, tmp_path):
    _, folder = evaluated
    done(opendr.run("data", "convert", coco128, tmp_path / "coco", "--to", "coco", "--as", "val2017", "--link"))
    truth = next((tmp_path / "coco/annotations").glob("instances_*.json"))
    ids = {image["file_name"]: image["id"] for image in json.loads(truth.read_text())["images"]}
    classes = [category["id"] for category in sorted(json.loads(truth.read_text())["categories"], key=lambda c: c["id"])]
    _, *lines = (json.loads(line) for line in (folder / "predictions.jsonl").read_text().splitlines())
    results = [
        {
            "image_id": ids[line["name"].rsplit("/", 1)[-1]],
            "category_id": classes[box["name"]],
            "bbox": [box[key] for key in ("left", "top", "width", "height")],
            "score": box["confidence"],
        }
        for line in lines
        for box in line["prediction"]["boxes"]
    ]
    (tmp_path / "results.json").write_text(json.dumps(results))
    stats = pycocotools(truth, str(tmp_path / "results.json"))
    for answers in ("results.json", folder / "predictions.jsonl"):
        scored = opendr.run("score", tmp_path / answers, tmp_path / "coco", "--metric", "coco_detection", "--json")
        scalars = json.loads(done(scored))["scalars"]
        ours = [scalars.get(name, -1) for name in NUMBERS]
        assert ours == pytest.approx(list(stats), abs=1e-6 if answers == "results.json" else 1e-4)


def test_data_set_against_itself_is_perfect(opendr, coco128):
    scored = opendr.run("score", coco128, coco128, "--metric", "coco_detection", "--json")
    assert json.loads(done(scored))["scalars"]["map"] > 0.999


def test_conversion_goes_round(opendr, coco128, tmp_path):
    done(opendr.run("data", "convert", coco128, tmp_path / "voc", "--to", "voc"))
    first = next((tmp_path / "voc/Annotations").glob("*.xml"))
    assert {child.tag for child in ElementTree.parse(first).getroot()} >= {"filename", "size", "object"}
    done(opendr.run("data", "convert", tmp_path / "voc", tmp_path / "yolo", "--to", "yolo"))
    count = lambda path: json.loads(done(opendr.run("data", "stats", path, "--json")))
    there, back = count(coco128), count(tmp_path / "yolo")
    assert (back["samples"], back["annotations"]) == (there["samples"], there["annotations"])
    assert back["classes"] == there["classes"]


def test_check_lists_what_is_broken_and_eval_leaves_it_out(opendr, coco128, tmp_path):
    done(opendr.run("data", "convert", coco128, tmp_path / "yolo", "--to", "yolo"))
    pictures = sorted((tmp_path / "yolo").rglob("*.jpg"))
    labels = {path.stem: path for path in (tmp_path / "yolo").rglob("*.txt")}
    pictures[0].write_bytes(pictures[0].read_bytes()[:200])
    labels[pictures[1].stem].write_text("0 0.5 0.5 nan 0.1\n")
    labels[pictures[2].stem].write_text("0 0.5 0.5 0.1 0.1\n99 0.5 0.5 0.1 0.1\n")
    pictures[3].unlink()
    checked = opendr.run("data", "check", tmp_path / "yolo", "--json")
    assert checked.returncode == 1
    problems = json.loads(checked.stdout)["list"]
    places = {(problem["file"].rsplit("/", 1)[-1], json.dumps(problem.get("location"))) for problem in problems}
    assert (pictures[0].name, "null") in places
    assert (f"{pictures[1].stem}.txt", '{"line": 1}') in places
    assert (f"{pictures[2].stem}.txt", '{"line": 2}') in places
    strict = opendr.run("eval", "centernet", tmp_path / "yolo", "--limit", 8)
    assert strict.returncode >= 11 and strict.stderr.count("error: ") == 1
    skipped = opendr.run("eval", "centernet", tmp_path / "yolo", "--limit", 8, "--skip-broken", "--json")
    assert skipped.returncode == 1
    outcome = json.loads(skipped.stdout)
    assert outcome["skipped"] >= 2 and outcome["counted"] >= 5 and outcome["complete"]


def test_view_draws_a_sheet(opendr, coco128, tmp_path):
    done(opendr.run("data", "view", coco128, "--out", tmp_path / "sheet.png", "--count", 7))
    assert min(cv2.imread(str(tmp_path / "sheet.png")).shape[:2]) > 300


def test_poses_are_evaluated_on_coco(opendr, shared, tmp_path):
    folder = shared / "data/mmpose_samples/coco"
    shutil.copytree(folder, tmp_path / "coco")
    outcome = json.loads(done(opendr.run("eval", "movenet/multipose", tmp_path / "coco", "--json", "--quiet")))
    assert outcome["metric"] == "coco_keypoints"
    assert 0.2 < outcome["scalars"]["map"] <= 1
    assert np.isfinite(list(outcome["scalars"].values())).all()


def test_wrong_use_is_told(opendr, coco128, tmp_path):
    for arguments, code, text in [
        (("eval", "centernet", tmp_path / "none"), 13, "no data set at"),
        (("eval", "centernet", tmp_path), 11, "not a data set of a known format"),
        (("eval", "centernet", coco128, "--format", "nonsense"), 13, "choose one of coco"),
        (("eval", "centernet", coco128, "--metric", "transcription"), 11, "needs the annotations"),
        (("eval", "centernet", coco128, "--metric-param", "use_classes"), 12, "NAME=VALUE"),
        (("eval", "centernet", coco128, "--metric-param", "nonsense=1"), 12, "it has max_detections"),
        (("score", tmp_path / "none.json", coco128, "--metric", "coco_detection"), 13, "none.json"),
        (("score", coco128, coco128), 12, "name a metric with --metric"),
    ]:
        process = opendr.run(*arguments)
        assert process.returncode == code, (arguments, process.stderr)
        assert text in process.stderr, process.stderr
