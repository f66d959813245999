"""Evaluation, inference and training on a real Ray cluster of this machine."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import opendr
import pytest
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import BoundingBox, BoundingBoxList, Category
from opendr.perception.object_detection_2d import YOLOv5DetectorLearner

from test_own_networks import FIXTURES, network

ray = pytest.importorskip("ray")

SAMPLES = 24
#: ONNX Runtime rounds otherwise with another number of threads.
THREADS = os.cpu_count()


def _end_once(kill):
    """Ends this process, unless it is the first of ``kill`` or another one has ended."""
    if kill is None or os.getpid() == kill[0]:
        return
    try:
        os.close(os.open(kill[1], os.O_CREAT | os.O_EXCL))
    except FileExistsError:
        return
    os.kill(os.getpid(), signal.SIGKILL)


class Noise(DatasetIterator):
    """Images of noise with a box each; with ``kill``, the first worker that reads sample 5 ends, once."""

    classes = [str(number) for number in range(80)]

    def __init__(self, size, kill=None):
        self.size, self.kill = size, kill

    def __len__(self):
        return SAMPLES

    def __getitem__(self, index):
        if index == 5:
            _end_once(self.kill)
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


class Shades(DatasetIterator):
    """Noisy images, dark and bright; with ``kill``, the first other process that reads sample 5 ends, once."""

    classes = ["dark", "bright"]

    def __init__(self, kill=None):
        self.kill = kill

    def __len__(self):
        return 44

    def __getitem__(self, index):
        if index == 5:
            _end_once(self.kill)
        noise = np.random.default_rng(index).integers(0, 128, (28, 28, 3), np.uint8)
        return Image(noise + 127 * (index % 2)), Category(index % 2)


def trained(out, dataset, **arguments):
    learner = opendr.learners()["image_classifier"]()
    fit = {"epochs": 3, "batch_size": 4, "accumulate": 2, "checkpoint_after_iter": 2, "silent": True}
    results = learner.fit(dataset, dataset, out=out, **fit, **arguments)
    # The file of the network for further training also has random ids of its parameters.
    return results, (out / "model" / "model.onnx").read_bytes()


@pytest.mark.filterwarnings("ignore")
def test_processes_of_a_cluster_train_the_weights_of_one(cluster, tmp_path):
    here, weights = trained(tmp_path / "here", Shades())
    there, those = trained(tmp_path / "there", Shades(), ray=True)
    assert weights == those and weights
    assert there["loss"] == here["loss"] and there["val_accuracy"] == here["val_accuracy"]

    killed = tmp_path / "killed"
    again, same = trained(tmp_path / "again", Shades((os.getpid(), str(killed))), ray=True)
    assert killed.exists(), "no process was killed"
    assert weights == same and again["loss"] == here["loss"]


def folder_of_shades(tmp_path):
    """Writes twelve images in a folder for each class."""
    for index in range(12):
        folder = tmp_path / "shades" / Shades.classes[index % 2]
        folder.mkdir(parents=True, exist_ok=True)
        Shades()[index][0].save(folder / f"{index}.png")
    return tmp_path / "shades"


def test_the_command_runs_on_a_cluster(tmp_path):
    dataset = folder_of_shades(tmp_path)

    def command(*words):
        words = [words[0], "image_classifier", str(dataset), *map(str, words[1:]), "--quiet", "--json"]
        done = subprocess.run([sys.executable, "-m", "opendr", *words], capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    fit = ["fit", "--epochs", "1", "--batch-size", "2", "--accumulate", "2"]
    for name, more in (("here", []), ("there", ["--ray", "local", "--threads", "1"])):
        assert command(*fit, "--out", tmp_path / name, *more)["complete"]
    here, there = ((tmp_path / name / "model" / "model.onnx").read_bytes() for name in ("here", "there"))
    assert here == there
    model = ["--model", tmp_path / "here" / "model"]
    assert without_times({"report": command("eval", *model)}) == without_times({"report": command("eval", *model, "--ray", "local")})


def test_ctrl_c_stops_a_training_on_a_cluster_which_resumes(tmp_path):
    dataset = folder_of_shades(tmp_path)
    out = tmp_path / "out"
    fit = ["fit", "image_classifier", dataset, "--batch-size", "2", "--accumulate", "2", "--out", out]
    fit = [sys.executable, "-m", "opendr", *map(str, fit), "--ray", "local", "--threads", "1", "--checkpoint-after-iter", "1"]
    running = subprocess.Popen([*fit, "--epochs", "100000"], start_new_session=True, stderr=subprocess.PIPE, text=True)
    try:
        deadline = time.monotonic() + 120
        while not any(out.glob("checkpoints/*/training_state.json")):
            assert running.poll() is None and time.monotonic() < deadline, running.stderr.read()
            time.sleep(0.1)
        # A terminal sends the signal to the whole group.
        os.killpg(running.pid, signal.SIGINT)
        _, errors = running.communicate(timeout=60)
    finally:
        running.kill()
    assert "stopped at step" in errors and "Traceback" not in errors, errors
    assert (out / "model" / "model.onnx").exists()
    steps = max(json.loads(path.read_text())["step"] for path in out.glob("checkpoints/*/training_state.json"))
    more = subprocess.run([*fit, "--epochs", str(steps // 3 + 2), "--resume"], capture_output=True, text=True, timeout=300)
    assert more.returncode == 0 and f"resumed at step {steps}" in more.stderr, more.stderr


@pytest.mark.filterwarnings("ignore")
def test_what_does_not_train_on_a_cluster_says_why(cluster, tmp_path):
    with pytest.raises(opendr.InvalidParam, match="set accumulate to a multiple"):
        opendr.learners()["image_classifier"]().fit(Shades(), out=tmp_path / "one", ray=True, silent=True)
    with pytest.raises(opendr.Unsupported, match="one process"):
        opendr.learners()["single_demo_grasp"]().fit(Shades(), out=tmp_path / "grasp", ray=True, silent=True)
    with pytest.raises(opendr.NotFound, match="does not exist"):
        opendr.learners()["image_classifier"]().fit(tmp_path / "none", out=tmp_path / "data", accumulate=2, ray=True, silent=True)


@pytest.mark.filterwarnings("ignore")
def test_episodes_on_the_cluster_are_those_of_one_machine(cluster, tmp_path):
    policy = opendr.learners()["ppo"]()
    policy.fit("CartPole-v1", out=tmp_path / "ppo", iters=2000, silent=True)
    here, there = (policy.eval(episodes=30, **where) for where in ({}, {"ray": True}))
    assert {**there, "seconds": 0} == {**here, "seconds": 0} and here["episodes"] == 30
    with pytest.raises(ValueError, match="at least one episode"):
        policy.eval(episodes=0, ray=True)
