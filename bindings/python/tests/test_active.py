"""Active perception: recognisers and rigs of the toolkit and of the user, and training on a data set."""

import json

import numpy as np
import opendr
import pytest
from opendr.active import Active, Axis, Pose
from opendr.engine.data import Image
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import Category, TrackingAnnotationList
from opendr.perception import active_perception
from opendr.perception.active_perception import ActivePoseRecognitionLearner

WORLD = "SphereView-Pose-v1"
CLASSES = [f"pose {index}" for index in range(10)]
SMALL = {
    "total_timesteps": 512, "view_episodes": 40, "epochs": 1, "kernels": 4, "hidden": 16, "n_envs": 4, "num_workers": 1,
    "calibration_episodes": 50,
}


@pytest.fixture(scope="module")
def learner(tmp_path_factory):
    learner = ActivePoseRecognitionLearner()
    learner.fit(WORLD, silent=True, out=tmp_path_factory.mktemp("active") / "run", **SMALL)
    learner.folder = tmp_path_factory.mktemp("model") / "model"
    learner.save(learner.folder)
    return learner


class Camera:
    """A rig whose images are brighter with each motion. It records the motions."""

    axes = [
        Axis("azimuth", 0.6, -np.pi, np.pi, wraps=True),
        Axis("elevation", 0.3, -0.9, 0.9),
        Axis("distance", -0.7, 2.7, 4.5),
    ]

    def __init__(self):
        self.moves = []

    def move(self, action):
        self.moves.append(action)

    def capture(self):
        return np.full((3, 20, 24), 20 * len(self.moves), np.uint8)


class Stuck(Camera):
    """A rig that carries out half of the azimuth alone, and states its pose."""

    pose = Pose(0.2, 0.1, 3.0)

    def move(self, action):
        super().move(action)
        self.pose = Pose(self.pose.azimuth + 0.3 * action[0], 0.1, 3.0)
        return [0.5 * action[0], 0.0, 0.0]


def unsure(image):
    """Never certain, so that a run uses its whole budget."""
    return np.full(10, 0.1)


def test_a_learner_of_active_perception_moves_its_rig(learner, tmp_path):
    outcome = Active(learner).run(WORLD, seed=3, out=tmp_path / "strip.png")
    assert (tmp_path / "strip.png").exists() and 1 <= len(outcome.views) <= 7
    assert outcome.category.probabilities.sum() == pytest.approx(1.0, abs=1e-4)
    assert outcome.category.confidence == pytest.approx(outcome.category.probabilities.max())
    *moved, last = outcome.views
    assert last.category.action is None and last.expected_gain is None and last.category.data == outcome.category.data
    for view in moved:
        assert len(view.category.action) == 3 and len(view.limits) == 3 and np.isfinite(view.expected_gain)
    assert [view.image.data.shape[0] for view in outcome.views] == [3] * len(outcome.views)
    again = Active(learner).run(WORLD, seed=3)
    assert [view.pose for view in again.views] == [view.pose for view in outcome.views]
    assert all(np.array_equal(one.image.data, two.image.data) for one, two in zip(again.views, outcome.views))
    # Live parameters of the learner are the stop rule.
    learner.moves = 0
    assert len(Active(learner).run(WORLD, seed=3).views) == 1
    learner.moves = 6


@pytest.mark.parametrize("subject", ["Face", "Object", "Pose"])
def test_pretrained_models(subject, tmp_path):
    cls = getattr(active_perception, f"Active{subject}RecognitionLearner")
    learner = cls(device="cpu")
    view = np.full((3, 48, 64), 90, np.uint8)
    with pytest.raises(FileNotFoundError, match=r"download\(\).*load\(\).*fit\(\)"):
        learner.infer(view)
    assert learner.load() is True and learner.is_ready and len(learner.classes) >= 10
    category = learner.infer(view)
    assert category.data in range(len(learner.classes)) and category.probabilities.sum() == pytest.approx(1.0, abs=1e-4)
    numbers = learner.eval(episodes=20)
    assert numbers["policy"]["accuracy"][0] > numbers["static"]["accuracy"][0] + 0.2
    learner.save(tmp_path / "saved")
    again = cls(device="cpu")
    again.load(tmp_path / "saved")
    assert again.infer(view).to_json() == category.to_json() and again.classes == learner.classes


def test_a_function_and_a_rig_of_ones_own(learner):
    camera = Camera()
    outcome = Active(unsure, learner.folder, classes=CLASSES).run(camera)
    assert outcome.reason == "budget" and len(outcome.views) == 7 and len(camera.moves) == 6
    assert outcome.category.description == CLASSES[outcome.category.data]
    for view, move in zip(outcome.views, camera.moves):
        assert list(view.category.action) == pytest.approx(move) and all(-1 <= axis <= 1 for axis in move)
    assert [int(view.image.data.max()) for view in outcome.views] == [20 * step for step in range(7)]
    # Without poses of its own, the rig is where its motions lead.
    first, second, *_ = outcome.views
    turned = (second.pose.azimuth - first.pose.azimuth + np.pi) % (2 * np.pi) - np.pi
    assert first.pose == pytest.approx((0.0, 0.0, 3.6, 0.0)) and turned == pytest.approx(0.6 * camera.moves[0][0], abs=1e-6)


def test_a_rig_states_what_it_carried_out(learner):
    camera = Stuck()
    outcome = Active(unsure, learner, classes=CLASSES).run(camera)
    assert outcome.views[0].pose == pytest.approx((0.2, 0.1, 3.0, 0.0))
    assert outcome.views[-1].pose == pytest.approx((*camera.pose,), abs=1e-6)
    for view in outcome.views[:-1]:
        stopped = [limit for axis, limit in zip(view.category.action, view.limits) if axis != 0]
        assert None not in stopped and "blocked" in stopped, view


def test_targets_and_learners_written_in_python_are_recognisers(learner):
    class Bright:
        """A learner of the user: the class is the brightness."""

        classes = CLASSES

        def infer(self, image):
            assert isinstance(image, Image)
            return Category(int(image.data.mean()) // 20 % 10, confidence=0.9)

    outcome = Active(Bright(), learner).run(Camera())
    assert outcome.views[0].category.data == 0 and outcome.views[0].category.description == "pose 0"


def test_images_and_recorded_views_are_rigs(learner, tmp_path):
    image = Image(np.random.default_rng(0).integers(0, 255, (3, 90, 160), np.uint8), guess_format=False)
    image.save(tmp_path / "hall.png")
    for rig in (image, tmp_path / "hall.png"):
        views = Active(unsure, learner, classes=CLASSES).run(rig, field_of_view=1.5).views
        assert len(views) == 7 and views[0].image.data.shape == (3, 224, 224)
    axes = [axis._asdict() for axis in Camera.axes]
    poses = [{"image": "hall.png", "pose": Pose(azimuth, 0.0, 3.0)._asdict()} for azimuth in (0.0, 1.0, -1.0)]
    (tmp_path / "views.json").write_text(json.dumps({"axes": axes, "views": poses}))
    outcome = Active(unsure, learner, classes=CLASSES).run(tmp_path / "views.json")
    assert {view.pose.azimuth for view in outcome.views} <= {0.0, 1.0, -1.0}


def test_another_learner_of_the_toolkit_is_made_active(learner, nanodet):
    # Its 80 classes are the belief's; the camera policy observes confidences alone.
    outcome = Active(nanodet, camera_policy=learner).run(WORLD, seed=1)
    assert len(outcome.category.probabilities) == len(nanodet.classes)
    with pytest.raises(ValueError, match="NanodetLearner has no camera policy"):
        Active(nanodet)


def test_what_does_not_fit_is_refused(learner):
    with pytest.raises(ValueError, match="has a camera policy of its own"):
        Active(learner, learner.folder)
    with pytest.raises(FileNotFoundError, match="no model is loaded"):
        Active(ActivePoseRecognitionLearner())
    with pytest.raises(ValueError, match="function has no camera policy"):
        Active(unsure, classes=CLASSES)
    with pytest.raises(ValueError, match="names of the classes are missing"):
        Active(unsure, learner)
    with pytest.raises(TypeError, match="learner or a function"):
        Active("nanodet", learner, classes=CLASSES)
    active = Active(unsure, learner, classes=CLASSES)
    with pytest.raises(FileNotFoundError, match="no rig"):
        active.run("nowhere.png")
    with pytest.raises(ValueError, match="no field_of_view"):
        active.run(WORLD, field_of_view=1.0)
    with pytest.raises(ValueError, match="rigs that are given by name"):
        active.run(Camera(), seed=1)

    class Flat(Camera):
        axes = Camera.axes[:1]

    with pytest.raises(ValueError, match="a policy of 3 axes for a rig of 1"):
        active.run(Flat())

    class Broken(Camera):
        def capture(self):
            raise RuntimeError("the lens is off")

    with pytest.raises(RuntimeError, match="the lens is off"):
        active.run(Broken())

    class Wild(Camera):
        def move(self, action):
            return [2.0, 0.0, 0.0]

    with pytest.raises(ValueError, match=r"move\(\) returns \[2.0, 0.0, 0.0\]"):
        active.run(Wild())
    for wrong, message in [([0.5] * 10, "whose sum is 1"), ([0.2] * 5, "of all 10 classes"), ([np.nan] * 10, "whose sum is 1")]:
        with pytest.raises(ValueError, match=message):
            Active(lambda image, wrong=wrong: wrong, learner, classes=CLASSES).run(Camera())
    with pytest.raises(ValueError, match="TrackingAnnotationList, which has no classes"):
        Active(lambda image: TrackingAnnotationList([]), learner, classes=CLASSES).run(Camera())


class Photos(DatasetIterator):
    """Labelled images of 10 classes, by their brightness."""

    classes = CLASSES

    def __init__(self, count):
        super().__init__()
        self.count = count

    def __len__(self):
        return self.count

    def __getitem__(self, index):
        label = index % 10
        noise = np.random.default_rng(index).integers(0, 20, (3, 64, 64))
        pixels = noise.astype(np.uint8)
        # A bright bar at the place of the class.
        pixels[:, :, 6 * label : 6 * label + 6] = 255
        return Image(pixels, guess_format=False), Category(label)


def test_a_recogniser_is_trained_on_a_data_set(tmp_path):
    learner = ActivePoseRecognitionLearner()
    few = {**SMALL, "epochs": 60}
    outcome = learner.fit(WORLD, dataset=Photos(200), limit=100, silent=True, out=tmp_path / "run", **few)
    assert outcome["report"]["samples"] == 100 and outcome["report"]["dataset"] == "Photos"
    assert json.loads((tmp_path / "run/report.json").read_text())["samples"] == 100
    learner.moves = 0
    found = [learner.infer(Photos(200)[index][0]).data for index in range(100, 140)]
    assert np.mean([data == index % 10 for index, data in enumerate(found)]) > 0.7, found


def test_wrong_arguments_of_the_training_are_refused(tmp_path):
    learner = ActivePoseRecognitionLearner()
    with pytest.raises(ValueError, match="give one as dataset"):
        learner.fit(WORLD, limit=10, out=tmp_path / "run")
    with pytest.raises(opendr.Unsupported, match="val_env is not supported"):
        learner.fit(WORLD, WORLD, out=tmp_path / "run")
    with pytest.raises(TypeError, match="ExternalDataset or a DatasetIterator"):
        learner.fit(WORLD, dataset=3, out=tmp_path / "run")
    with pytest.raises(ValueError, match="no class of the environment"):
        shifted = [(Photos(1)[0][0], Category(10))]
        learner.fit(WORLD, dataset=shifted, silent=True, out=tmp_path / "run", **SMALL)
