"""The two programs of the paper, word for word. Their models come with the training work: until then they must fail for
that reason and no other."""

import os
import subprocess
import sys

import pytest

DETECTION = '''\
from opendr.perception.object_detection_2d import SingleShotDetectorLearner
from opendr.perception.object_detection_2d import draw_bounding_boxes
from opendr.engine.data import Image

ssd = SingleShotDetectorLearner(device="cuda")
ssd.download(".", mode="pretrained")
ssd.load("./ssd_default_person", verbose=True)

img = Image.open("example.jpg")
boxes = ssd.infer(img)
draw_bounding_boxes(img.opencv(), boxes, class_names=ssd.classes, show=True)
'''

POSES = '''\
from opendr.perception.pose_estimation import LightweightOpenPoseLearner
from opendr.engine.data import Image

pose_estimator = LightweightOpenPoseLearner(device="cuda")
pose_estimator.download(path=".")
pose_estimator.load("openpose_default")

img = Image.open("example.png")
poses = pose_estimator.infer(img)
print(poses)
'''

WITHOUT_MODELS = "its learner and weights come with training"


def run(program, folder, test_data):
    from opendr.engine.data import Image

    for name, photo in (("example.jpg", "bus.jpg"), ("example.png", "zidane.jpg")):
        Image.open(test_data / "data/photos" / photo).save(folder / name)
    env = {**os.environ, "OPENDR_DEVICE": "cpu", "DISPLAY": "", "WAYLAND_DISPLAY": ""}
    done = subprocess.run([sys.executable, "-c", program], cwd=folder, env=env, capture_output=True, text=True)
    if "cannot import name" in done.stderr and "Learner'" in done.stderr:
        raise ImportError(done.stderr)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.xfail(strict=True, raises=ImportError, reason=WITHOUT_MODELS)
def test_person_detection(tmp_path, test_data):
    run(DETECTION, tmp_path, test_data)


@pytest.mark.xfail(strict=True, raises=ImportError, reason=WITHOUT_MODELS)
def test_pose_estimation(tmp_path, test_data):
    assert "Keypoints name-position:" in run(POSES, tmp_path, test_data)
