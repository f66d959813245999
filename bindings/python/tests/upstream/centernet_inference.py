"""CenterNet with all positional arguments of OpenDR's constructor."""

from opendr.engine.data import Image
from opendr.perception.object_detection_2d import CenterNetDetectorLearner
from opendr.perception.object_detection_2d.utils.vis_utils import draw_bounding_boxes, draw_detections

centernet = CenterNetDetectorLearner(
    0.001, 120, 8, "cpu", "resnet50_v1b", 512, "step", "", 0, 0, 5, 100, 8, 0.0005, 0.9, 1.0, 0.1, 1.0, "80,100", 0.1,
    0, False,
)  # fmt: skip
assert (centernet.device, centernet.lr, centernet.batch_size, centernet.scale) == ("cpu", 0.001, 8, 1.0)
centernet.download(".", mode="pretrained")
centernet.load("./centernet_default", verbose=True)
centernet.download(".", mode="images")
img = Image.open("./bicycles.jpg")
boxes = centernet.infer(img, threshold=0.4, keep_size=True)
assert "person" in {centernet.classes[box.name] for box in boxes}
frame = draw_bounding_boxes(img.opencv(), boxes, centernet.classes, False)
corners = [[box.left, box.top, box.left + box.width, box.top + box.height] for box in boxes]
again = draw_detections(
    img.opencv(), corners, [box.confidence for box in boxes], [box.name for box in boxes], centernet.classes
)
assert (frame == again).all()
