"""Evaluation and inference on a real Ray cluster of this machine."""

import json
import os
import shutil
import signal
import sys

import numpy as np
import opendr
import pytest
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import BoundingBox, BoundingBoxList
from opendr.perception.object_detection_2d import YOLOv5DetectorLearner

from test_own_networks import FIXTURES, network

ray = pytest.importorskip("ray")

SAMPLES = 24
#: ONNX Runtime rounds otherwise with another number of threads.
THREADS = os.cpu_count()


class Noise(DatasetIterator):
    """Images of noise with a box each; with ``kill``, the first worker that reads sample 5 ends, once."""

    classes = [str(number) for number in range(80)]

    def __init__(self, size, kill=None):
        self.size, self.kill = size, kill

    def __len__(self):
        return SAMPLES

    def __getitem__(self, index):
        if self.kill is not None and index == 5 and os.getpid() != self.kill[0]:
            try:
                os.close(os.open(self.kill[1], os.O_CREAT | os.O_EXCL))
            except FileExistsError:
                pass
            else:
                os.kill(os.getpid(), signal.SIGKILL)
        width, height = self.size
        image = np.random.default_rng(index).integers(0, 256, (height, width, 3), np.uint8)
        return Image(image), BoundingBoxList([BoundingBox(name=0, left=1, top=1, width=20, height=20)])


@pytest.fixture(scope="module")
def cluster():
    variables = {"PYTHONPATH": os.pathsep.join(sys.path)}
    ray.init(num_cpus=2 * THREADS, include_dashboard=False, log_to_driver=False, runtime_env={"env_vars": variables})
    yield
    ray.shutdown()


@pytest.fixture(scope="module")
def detector(tmp_path_factory):
    facts = json.loads((FIXTURES / "yolo.json").read_text())
    learner = YOLOv5DetectorLearner("custom", network("yolo", tmp_path_factory.mktemp("network")), "cpu")
    learner.threshold = facts["threshold"]
    return learner, tuple(facts["image"])


def without_times(results):
    report = {name: value for name, value in results["report"].items() if name not in ("seconds", "written")}
    return {**results, "report": report}


@pytest.mark.filterwarnings("ignore")
def test_an_evaluation_on_the_cluster_is_that_of_one_machine(cluster, detector, tmp_path):
    learner, size = detector
    here = learner.eval(Noise(size), by_number=True, out=tmp_path / "here")
    there = learner.eval(Noise(size), by_number=True, out=tmp_path / "there", ray=True, ray_options={"num_cpus": THREADS})
    assert without_times(there) == without_times(here)
    journal = (tmp_path / "there" / "predictions.jsonl").read_text()
    assert journal == (tmp_path / "here" / "predictions.jsonl").read_text() and journal.count("\n") == SAMPLES + 1
    assert ray.is_initialized(), "a cluster that was there is left alone"

    # It resumes after whole lines; an incomplete one is predicted again.
    shutil.copytree(tmp_path / "there", tmp_path / "resumed")
    (tmp_path / "resumed" / "predictions.jsonl").write_text("".join(journal.splitlines(True)[:8])[:-5])
    again = learner.eval(Noise(size), by_number=True, out=tmp_path / "resumed", ray=True, ray_options={"num_cpus": THREADS})
    assert without_times(again) == without_times(here)
    assert (tmp_path / "resumed" / "predictions.jsonl").read_text() == journal
    with pytest.raises(opendr.InvalidInput, match="another evaluation"):
        learner.eval(Noise(size), by_number=True, limit=4, out=tmp_path / "resumed", ray=True)


@pytest.mark.filterwarnings("ignore")
def test_a_killed_worker_loses_nothing(cluster, detector, tmp_path):
    learner, size = detector
    killed = tmp_path / "killed"
    there = learner.eval(Noise(size, (os.getpid(), str(killed))), by_number=True, ray=True, ray_options={"num_cpus": THREADS})
    assert killed.exists(), "no worker was killed"
    here = learner.eval(Noise(size), by_number=True)
    assert without_times(there) == without_times(here)


@pytest.mark.filterwarnings("ignore")
def test_inputs_are_predicted_on_the_cluster(cluster, detector):
    learner, size = detector
    images = [Noise(size)[index][0] for index in range(20)]
    here = learner.infer(images)
    there = {"ray": True, "ray_options": {"num_cpus": THREADS}}
    assert learner.infer(images, **there) == here
    assert list(learner.infer(iter(images), threshold=0.9, **there)) == learner.infer(images, threshold=0.9)
    with pytest.raises(TypeError, match="a list or an iterator"):
        learner.infer(images[0], ray=True)
    with pytest.raises(opendr.Unsupported, match="has a state"):
        opendr.learner("byte_track").infer(here, ray=True)
