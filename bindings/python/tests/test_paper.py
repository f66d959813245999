"""The two programs of the paper, word for word, each from an empty folder and without a network."""

import json
import os
import subprocess
import sys

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

#: Expected detections: images with people, and the centres of these.
PEOPLE = {"bus.jpg": [(146, 650), (283, 630), (738, 640)], "zidane.jpg": [(430, 450), (930, 380)]}


def run(program, folder, test_data):
    from opendr.engine.data import Image

    for name, photo in (("example.jpg", "bus.jpg"), ("example.png", "zidane.jpg")):
        Image.open(test_data / "data/photos" / photo).save(folder / name)
    env = {**os.environ, "OPENDR_DEVICE": "cpu", "DISPLAY": "", "WAYLAND_DISPLAY": "", "OPENDR_OFFLINE": "1"}
    env = {name: value for name, value in env.items() if name != "OPENDR_MODEL_REPOSITORY"}
    env["OPENDR_CACHE"] = str(folder / "cache")
    done = subprocess.run([sys.executable, "-c", program], cwd=folder, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_person_detection(tmp_path, test_data):
    run(DETECTION, tmp_path, test_data)
    assert (tmp_path / "ssd_default_person/model.json").is_file()
    seen = "print([[box.left, box.top, box.width, box.height] for box in boxes])"
    boxes = json.loads(run(f"{DETECTION}{seen}\n", tmp_path, test_data).splitlines()[-1])
    for x, y in PEOPLE["bus.jpg"]:
        assert any(left < x < left + width and top < y < top + height for left, top, width, height in boxes)


def test_pose_estimation(tmp_path, test_data):
    assert "Keypoints name-position:" in run(POSES, tmp_path, test_data)
    seen = "import json\nprint(json.dumps([pose.data.tolist() for pose in poses]))"
    poses = json.loads(run(f"{POSES}{seen}\n", tmp_path, test_data).splitlines()[-1])
    for x, _ in PEOPLE["zidane.jpg"]:
        assert any(sum(joint[0] >= 0 and abs(joint[0] - x) < 250 for joint in pose) >= 5 for pose in poses)
