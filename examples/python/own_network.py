"""Runs a detector that another tool exported to ONNX. Inputs: my_detector.onnx, for instance YOLOX-nano, and street.jpg."""

from opendr.perception.object_detection_2d import ImportedDetectorLearner

detector = ImportedDetectorLearner(threshold=0.5)
detector.load("my_detector.onnx")
boxes = detector.infer("street.jpg")
for box in boxes:
    # The file states no names of its classes.
    print(f"class {box.name}, score {box.confidence:.2f}")
boxes.save("own_network.png")
