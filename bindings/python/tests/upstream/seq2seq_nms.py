"""Non-maximum suppression of a detector's boxes by attention."""

import os

from opendr.engine.data import Image
from opendr.perception.object_detection_2d import NanodetLearner, Seq2SeqNMSLearner, SingleShotDetectorLearner

path = "./tmp"
learner = Seq2SeqNMSLearner(device="cpu", app_feats="fmod", fmod_map_type="EDGEMAP", iou_filtering=1.0, temp_path=path)
learner.download(model_name="seq2seq_pets_ssd_pets_fmod", path=path)
learner.load(os.path.join(path, "seq2seq_pets_ssd_pets_fmod"), verbose=True)
ssd = SingleShotDetectorLearner(device="cpu")
ssd.download(".", mode="pretrained")
ssd.load("ssd_default_person", verbose=True)
img = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/bus.jpg"))
boxes = ssd.infer(img, threshold=0.02, custom_nms=learner)
assert len(boxes) >= 1 and all(box.class_name == "person" for box in boxes)

corners = [[box.left, box.top, box.left + box.width, box.top + box.height] for box in boxes]
chosen, (places, classes, scores) = learner.run_nms(corners, [box.confidence for box in boxes], img=img, threshold=0.0)
assert len(chosen) == len(places) == len(classes) == len(scores)
nanodet = NanodetLearner(device="cpu")
nanodet.load()
assert len(learner.infer(img, nanodet.infer(img, iou_threshold=1.0, conf_threshold=0.2))) >= 3
