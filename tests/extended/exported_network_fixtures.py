"""Writes the fixtures of networks that other tools exported: small networks with random weights, exported by their own packages, and the
predictions of the packages' own post-processing on one image.

    python tests/extended/exported_network_fixtures.py crates/perception [PACKAGE...]

It needs torch, torchvision, ultralytics, transformers, rtmlib, MMPose's wheel (unpacked, on PYTHONPATH), YOLOX from its repository, onnx and
onnxruntime, and downloads nothing. Each
fixture is a container NAME.zip and the predictions NAME.json in tests/imported of detection, pose, classification, segmentation and depth; that of YOLOX is the
model of the test data (OPENDR_TEST_DATA). The packages' code is run, not copied; no weights of theirs are involved.
"""

import hashlib
import json
import os
import sys
import tempfile
import zipfile
from pathlib import Path

os.environ.update(YOLO_AUTOINSTALL="false", YOLO_OFFLINE="true", HF_HUB_OFFLINE="1")

import numpy as np
import onnxruntime
import torch

SIDE = 64
IOU = 0.5
CLASSES = ["ball", "cone", "door"]


def image(width, height):
    """The image of every fixture, RGB; tests/imported/main.rs computes the same."""
    y, x, c = np.meshgrid(np.arange(height), np.arange(width), np.arange(3), indexing="ij")
    return ((x * 5 + y * 11 + c * 71 + x * y // 7) % 256).astype(np.uint8)


def randomise(model, seed, density=0.5):
    """Sparse weights of one magnitude per layer, which make scores differ and compress well."""
    generator = torch.Generator().manual_seed(seed)
    for name, parameter in model.named_parameters():
        if name.endswith("bias"):
            # Ultralytics gives boxes a positive size, and classes a bias that depends on their number.
            parameter.data.fill_(3.0 if ".cv2." in name and name.endswith(".2.bias") else 0.0)
        elif parameter.dim() > 1:
            fan_in = parameter[0].numel()
            kept = torch.rand(parameter.shape, generator=generator) < density
            signs = torch.rand(parameter.shape, generator=generator).sub(0.5).sign()
            parameter.data = kept * signs * (2 / (fan_in * density)) ** 0.5


def runs(mask):
    """Run lengths of a mask, column by column, as in COCO."""
    flat = np.asarray(mask, bool).flatten(order="F")
    ends = np.flatnonzero(np.diff(np.concatenate([[False], flat, [not flat[-1]]]).astype(np.int8)))
    return np.diff(np.concatenate([[0], ends])).tolist()


def write_container(path, onnx, learner, task):
    onnx = Path(onnx).read_bytes()
    entry = {"name": "model.onnx", "size": len(onnx), "sha256": hashlib.sha256(onnx).hexdigest()}
    manifest = {
        "format_version": 1,
        "learner": learner,
        "task": task,
        "params": {},
        "classes": [],
        "files": [entry],
    }
    # Entries with one date, so that the same networks give the same bytes.
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        archive.writestr(zipfile.ZipInfo("model.json"), json.dumps(manifest))
        archive.writestr(zipfile.ZipInfo("model.onnx"), onnx, compress_type=zipfile.ZIP_DEFLATED, compresslevel=9)
    print(f"{path.name}: {path.stat().st_size} bytes")


def write(root, name, onnx, detections, size, threshold, iou=IOU, masks=None, polygons=None):
    """Writes a container and its detections; `detections` are rows of x0, y0, x1, y1, score, class in image pixels, `masks` their masks,
    `polygons` the corners of their rotated boxes."""
    folder = imported(root, "detection")
    write_container(folder / f"{name}.zip", onnx, "detector", "object_detection_2d")
    rows = [[round(float(value), 5) for value in row] for row in detections]
    order = sorted(range(len(rows)), key=lambda index: -rows[index][4])
    rows = [rows[index] for index in order]
    expected = {"image": size, "threshold": threshold, "iou_threshold": iou, "detections": rows}
    if masks is not None:
        expected["masks"] = [runs(masks[index]) for index in order]
    if polygons is not None:
        expected["polygons"] = [[round(float(v), 4) for v in polygons[index].flatten()] for index in order]
    (folder / f"{name}.json").write_text(json.dumps(expected) + "\n")


def write_poses(root, name, onnx, boxes, keypoints, size, threshold):
    """Writes a container and its poses; `boxes` as in `write`, `keypoints` their x, y, score in image pixels."""
    folder = imported(root, "pose")
    write_container(folder / f"{name}.zip", onnx, "pose_estimator", "pose_estimation")
    poses = [
        {"box": [round(float(value), 5) for value in box], "keypoints": [[round(float(v), 5) for v in point] for point in points]}
        for box, points in zip(boxes, keypoints)
    ]
    expected = {"image": size, "threshold": threshold, "iou_threshold": IOU, "poses": poses}
    (folder / f"{name}.json").write_text(json.dumps(expected) + "\n")


def imported(root, crate):
    folder = root / crate / "tests/imported"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def threshold_for(scores, count):
    """A threshold that `count` scores reach, halfway between two of them."""
    ordered = scores.flatten().sort(descending=True).values
    return float(ordered[count - 1 : count + 1].mean())


def outputs_of(onnx, **inputs):
    session = onnxruntime.InferenceSession(str(onnx), providers=["CPUExecutionProvider"])
    names = [one.name for one in session.get_inputs()]
    return session.run(None, {name: inputs[name] for name in names})


def ultralytics(folder):
    import yaml
    from ultralytics import RTDETR, YOLO
    from ultralytics.data.augment import LetterBox
    from ultralytics.utils.nms import non_max_suppression
    from ultralytics.utils.ops import (
        process_mask_native,
        regularize_rboxes,
        scale_boxes,
        scale_coords,
        xywh2xyxy,
        xywhr2xyxyxyxy,
    )

    convolutions = [[-1, 1, "Conv", [16, 3, 2]]] * 3 + [[-1, 1, "Conv", [32, 3, 2]], [-1, 1, "Conv", [48, 3, 2]]]
    heads = {
        "detect": [[2, 3, 4], 1, "Detect", ["nc"]],
        "segment": [[2, 3, 4], 1, "Segment", ["nc", 4, 8]],
        "pose": [[2, 3, 4], 1, "Pose", ["nc", "kpt_shape"]],
        "obb": [[2, 3, 4], 1, "OBB", ["nc", 1]],
    }
    person = {"nc": 1, "kpt_shape": [17, 3]}
    pairs = {"kpt_shape": [6, 2]}
    cases = [
        ("yolo", "detect", {}, {}),
        ("yolo_segment", "segment", {}, {}),
        ("yolo_pose", "pose", {}, {}),
        ("yolo_pose_person", "pose", person, {}),
        ("yolo_pose_pairs", "pose", pairs, {}),
        ("yolo_pose_end_to_end", "pose", {"end2end": True}, {"nms": False}),
        ("yolo_pose_nms", "pose", {}, {"nms": True, "conf": 0.3, "iou": IOU}),
        ("yolo_obb", "obb", {}, {}),
        ("yolo_obb_end_to_end", "obb", {"end2end": True}, {"nms": False}),
        ("yolo_end_to_end", "detect", {"end2end": True}, {"nms": False}),
        ("yolo_nms", "detect", {}, {"nms": True, "conf": 0.3, "iou": IOU}),
    ]
    width, height = SIDE, SIDE * 3 // 4
    rgb = image(width, height)
    boxed = LetterBox((SIDE, SIDE), auto=False)(image=rgb)
    tensor = np.ascontiguousarray(boxed.transpose(2, 0, 1)[None].astype(np.float32) / 255)
    for name, task, options, export in cases:
        spec = {"nc": 3, "reg_max": 1, "scales": {"n": [1, 1, 1024]}, "kpt_shape": [5, 3]}
        spec |= {"backbone": convolutions, "head": [heads[task]], **options}
        count = spec["nc"]
        path = Path(f"yolo11n-{name}.yaml")
        path.write_text(yaml.safe_dump(spec))
        model = YOLO(path, task=task)
        randomise(model.model, len(name))
        model.model.names = dict(enumerate(CLASSES if count == 3 else ["person"]))
        onnx = model.export(format="onnx", imgsz=SIDE, simplify=False, opset=17, **export)
        outputs = [torch.from_numpy(output) for output in outputs_of(onnx, images=tensor)]
        rows = outputs[0]
        if export:
            scores = rows[0, :, 4]
            threshold = threshold_for(scores, min(12, int((scores > 0).sum()) - 1))
            kept = rows[0][scores > threshold]
        else:
            threshold = threshold_for(rows[0, 4 : 4 + count].amax(0), 60)
            kept = non_max_suppression(rows, threshold, IOU, nc=count, rotated=task == "obb")[0]
        if task == "obb":
            rotated = regularize_rboxes(torch.cat([kept[:, :4], kept[:, -1:]], 1))
            rotated[:, :4] = scale_boxes((SIDE, SIDE), rotated[:, :4], (height, width), xywh=True)
            corners = xywhr2xyxyxyxy(rotated)
            kept[:, :2], kept[:, 2:4] = corners.amin(1), corners.amax(1)
            kept[:, 0:4:2] = kept[:, 0:4:2].clamp(0, width)
            kept[:, 1:4:2] = kept[:, 1:4:2].clamp(0, height)
            write(folder, name, onnx, kept[:, :6], [width, height], threshold, polygons=corners)
            continue
        kept[:, :4] = scale_boxes((SIDE, SIDE), kept[:, :4], (height, width))
        if task == "pose":
            points = kept[:, 6:].reshape(len(kept), *spec["kpt_shape"])
            points = scale_coords((SIDE, SIDE), points, (height, width))
            write_poses(folder, name, onnx, kept[:, :6], points, [width, height], threshold)
        if name.startswith("yolo_pose_"):
            continue
        masks = None
        if task == "segment":
            masks = process_mask_native(outputs[1][0], kept[:, 6:], kept[:, :4], (height, width)).bool().numpy()
        write(folder, name, onnx, kept[:, :6], [width, height], threshold, masks=masks)

    spec = {"nc": 3, "scales": {"n": [1, 1, 1024]}, "backbone": convolutions, "head": [[-1, 1, "Classify", ["nc"]]]}
    Path("yolo11n-cls-tiny.yaml").write_text(yaml.safe_dump(spec))
    model = YOLO("yolo11n-cls-tiny.yaml", task="classify")
    randomise(model.model, 9)
    model.model.names = dict(enumerate(CLASSES))
    onnx = model.export(format="onnx", imgsz=SIDE, simplify=False, opset=17)
    square = np.ascontiguousarray(image(SIDE, SIDE).transpose(2, 0, 1)[None].astype(np.float32) / 255)
    scores = outputs_of(onnx, images=square)[0][0]
    folder_of_classes = imported(folder, "classification")
    write_container(folder_of_classes / "yolo_classify.zip", onnx, "classifier", "image_classification")
    expected = {"image": [SIDE, SIDE], "scores": [round(float(score), 6) for score in scores]}
    (folder_of_classes / "yolo_classify.json").write_text(json.dumps(expected) + "\n")

    decoder = [[2, 3, 4], 1, "RTDETRDecoder", ["nc", 32, 20, 2, 4, 1, 64]]
    spec = {"nc": 3, "scales": {"l": [1, 1, 1024]}, "backbone": convolutions, "head": [decoder]}
    Path("rtdetr-tiny.yaml").write_text(yaml.safe_dump(spec))
    model = RTDETR("rtdetr-tiny.yaml")
    randomise(model.model, 7)
    model.model.names = dict(enumerate(CLASSES))
    onnx = model.export(format="onnx", imgsz=SIDE, simplify=False, opset=17)
    square = np.ascontiguousarray(image(SIDE, SIDE).transpose(2, 0, 1)[None].astype(np.float32) / 255)
    rows = torch.from_numpy(outputs_of(onnx, images=square)[0])[0]
    scores, classes = rows[:, 4], rows[:, 5]
    boxes = xywh2xyxy(rows[:, :4]) * SIDE
    threshold = threshold_for(scores, 8)
    kept = torch.cat([boxes.clamp(0, SIDE), scores[:, None], classes[:, None].float()], 1)[scores > threshold]
    write(folder, "rtdetr_ultralytics", onnx, kept, [SIDE, SIDE], threshold)


def yolox(folder):
    """The detections of YOLOX-nano in photos of the test data, cut to the network's input so that nothing is resized."""
    import cv2
    from yolox.utils.boxes import postprocess
    from yolox.utils.demo_utils import demo_postprocess

    data = Path(os.environ["OPENDR_TEST_DATA"])
    threshold, iou, side, photos = 0.05, 0.45, 416, {}
    for name in ("astronaut.png", "chelsea.png", "coffee.png", "motorcycle_left.png"):
        photo = cv2.imread(str(data / "data/photos" / name))[:side, :side]
        height, width = photo.shape[:2]
        padded = np.full((side, side, 3), 114, np.uint8)
        padded[:height, :width] = photo
        tensor = padded.transpose(2, 0, 1)[None].astype(np.float32)
        rows = demo_postprocess(outputs_of(data / "models/found/yolox_nano.onnx", images=tensor)[0], (side, side))
        found = postprocess(torch.from_numpy(rows), 80, threshold, iou)[0]
        found[:, [0, 2]] = found[:, [0, 2]].clamp(0, width)
        found[:, [1, 3]] = found[:, [1, 3]].clamp(0, height)
        found[:, 4] *= found[:, 5]
        photos[name] = [[round(float(value), 5) for value in row] for row in found[:, [0, 1, 2, 3, 4, 6]]]
        print(f"yolox {name}: {len(photos[name])} detections")
    expected = {"threshold": threshold, "iou_threshold": iou, "photos": photos}
    (imported(folder, "detection") / "yolox_nano.json").write_text(json.dumps(expected) + "\n")


def torchvision(folder):
    from torchvision.models.detection import RetinaNet
    from torchvision.models.detection.anchor_utils import AnchorGenerator

    class Backbone(torch.nn.Sequential):
        out_channels = 16

    layers = [torch.nn.Conv2d(3, 16, 3, 8, 1), torch.nn.ReLU(), torch.nn.Conv2d(16, 16, 3, 2, 1), torch.nn.ReLU()]
    anchors = AnchorGenerator(((16, 32),), ((0.5, 1.0, 2.0),))
    model = RetinaNet(Backbone(*layers), 4, min_size=SIDE, max_size=SIDE, anchor_generator=anchors, score_thresh=0.3)
    randomise(model, 3)
    torch.nn.init.zeros_(model.head.classification_head.cls_logits.bias)
    model.eval()
    rgb = torch.from_numpy(image(SIDE, SIDE).transpose(2, 0, 1).astype(np.float32) / 255)
    names = {"input_names": ["images"], "output_names": ["boxes", "scores", "labels"]}
    torch.onnx.export(model, ([rgb],), "retinanet.onnx", opset_version=17, dynamo=False, **names)
    with torch.no_grad():
        found = model([rgb])[0]
    threshold = threshold_for(found["scores"], 30)
    kept = found["scores"] > threshold
    rows = [found["boxes"], found["scores"][:, None], found["labels"][:, None]]
    write(folder, "torchvision_retinanet", "retinanet.onnx", torch.cat(rows, 1)[kept], [SIDE, SIDE], threshold)


def transformers(folder):
    from transformers import (
        DetrConfig,
        DetrForObjectDetection,
        DetrImageProcessor,
        ResNetConfig,
        RTDetrConfig,
        RTDetrForObjectDetection,
        RTDetrImageProcessor,
        RTDetrResNetConfig,
    )

    rgb = image(SIDE, SIDE)
    levels = rgb.astype(np.float32).transpose(2, 0, 1)[None] / 255
    mean, std = np.array([0.485, 0.456, 0.406]), np.array([0.229, 0.224, 0.225])
    normalised = ((levels - mean[:, None, None]) / std[:, None, None]).astype(np.float32)
    small = {"d_model": 16, "encoder_ffn_dim": 16, "decoder_ffn_dim": 16}
    detr = DetrConfig(
        use_timm_backbone=False, use_pretrained_backbone=False, backbone=None, num_labels=3, num_queries=100,
        backbone_config=ResNetConfig(hidden_sizes=[8, 8, 8, 8], depths=[1, 1, 1, 1], embedding_size=8, out_features=["stage4"]),
        encoder_layers=1, decoder_layers=1, encoder_attention_heads=2, decoder_attention_heads=2, **small,
    )
    backbone = RTDetrResNetConfig(
        hidden_sizes=[8, 8, 16, 16], depths=[1, 1, 1, 1], embedding_size=8, layer_type="basic",
        out_features=["stage2", "stage3", "stage4"],
    )
    rt_detr = RTDetrConfig(
        use_timm_backbone=False, use_pretrained_backbone=False, backbone=None, backbone_config=backbone, num_labels=3,
        num_queries=20, encoder_in_channels=[8, 16, 16], encoder_hidden_dim=16, feat_strides=[8, 16, 32],
        decoder_in_channels=[16, 16, 16], decoder_layers=1, encoder_attention_heads=2, decoder_attention_heads=2,
        hidden_expansion=1.0, anchor_image_size=[SIDE, SIDE], **small,
    )
    cases = [
        ("detr", DetrForObjectDetection, detr, DetrImageProcessor(), normalised),
        ("rt_detr", RTDetrForObjectDetection, rt_detr, RTDetrImageProcessor(), levels),
    ]
    for name, model, config, processor, pixels in cases:
        torch.manual_seed(5)
        model = model(config)
        randomise(model, 5)
        model.eval()

        class Outputs(torch.nn.Module):
            def __init__(self, inner):
                super().__init__()
                self.inner = inner

            def forward(self, pixel_values):
                found = self.inner(pixel_values=pixel_values, return_dict=True)
                return found.logits, found.pred_boxes

        names = {"input_names": ["pixel_values"], "output_names": ["logits", "pred_boxes"]}
        pixels = torch.from_numpy(pixels)
        torch.onnx.export(Outputs(model), (pixels,), f"{name}.onnx", opset_version=17, dynamo=False, **names)
        logits, boxes = (torch.from_numpy(one) for one in outputs_of(f"{name}.onnx", pixel_values=pixels.numpy()))
        found = type("Found", (), {"logits": logits, "pred_boxes": boxes})()
        scores = processor.post_process_object_detection(found, 0.0, [(SIDE, SIDE)])[0]["scores"]
        threshold = threshold_for(scores, 8)
        found = processor.post_process_object_detection(found, threshold, [(SIDE, SIDE)])[0]
        rows = [found["boxes"].clamp(0, SIDE), found["scores"][:, None], found["labels"][:, None]]
        write(folder, name, f"{name}.onnx", torch.cat(rows, 1), [SIDE, SIDE], threshold)


def write_labels(root, name, onnx, labels):
    """Writes a container of a segmenter and the classes of every pixel, a text of digits for each row."""
    folder = imported(root, "segmentation")
    write_container(folder / f"{name}.zip", onnx, "segmenter", "semantic_segmentation")
    rows = ["".join(map(str, row)) for row in np.asarray(labels).tolist()]
    assert len(set("".join(rows))) > 1, f"{name} predicts one class only"
    (folder / f"{name}.json").write_text(json.dumps({"image": [SIDE, SIDE], "labels": rows}) + "\n")


def segmenters(folder):
    """Segmenters of torchvision and transformers."""
    from torchvision.models._utils import IntermediateLayerGetter
    from torchvision.models.segmentation.fcn import FCN, FCNHead
    from transformers import SegformerConfig, SegformerForSemanticSegmentation, SegformerImageProcessor

    levels = image(SIDE, SIDE).astype(np.float32).transpose(2, 0, 1)[None] / 255
    mean, std = np.array([0.485, 0.456, 0.406]), np.array([0.229, 0.224, 0.225])
    pixels = torch.from_numpy(((levels - mean[:, None, None]) / std[:, None, None]).astype(np.float32))

    layers = torch.nn.Sequential()
    layers.add_module("low", torch.nn.Sequential(torch.nn.Conv2d(3, 16, 3, 4, 1), torch.nn.ReLU()))
    layers.add_module("high", torch.nn.Sequential(torch.nn.Conv2d(16, 16, 3, 2, 1), torch.nn.ReLU()))
    backbone = IntermediateLayerGetter(layers, {"low": "aux", "high": "out"})
    model = FCN(backbone, FCNHead(16, 4), FCNHead(16, 4))
    randomise(model, 11)
    model.eval()
    names = {"input_names": ["input"], "output_names": ["out", "aux"]}
    torch.onnx.export(model, (pixels,), "fcn.onnx", opset_version=17, dynamo=False, **names)
    with torch.no_grad():
        write_labels(folder, "torchvision_fcn", "fcn.onnx", model(pixels)["out"].argmax(1)[0])

    config = SegformerConfig(
        num_labels=5, depths=[1, 1, 1, 1], hidden_sizes=[8, 8, 16, 16], num_attention_heads=[1, 1, 2, 2], decoder_hidden_size=16
    )
    torch.manual_seed(5)
    model = SegformerForSemanticSegmentation(config)
    randomise(model, 5)
    model.eval()

    class Logits(torch.nn.Module):
        def __init__(self, inner):
            super().__init__()
            self.inner = inner

        def forward(self, pixel_values):
            return self.inner(pixel_values=pixel_values, return_dict=True).logits

    names = {"input_names": ["pixel_values"], "output_names": ["logits"]}
    torch.onnx.export(Logits(model), (pixels,), "segformer.onnx", opset_version=17, dynamo=False, **names)
    found = type("Found", (), {"logits": torch.from_numpy(outputs_of("segformer.onnx", pixel_values=pixels.numpy())[0])})()
    [labels] = SegformerImageProcessor().post_process_semantic_segmentation(found, [(SIDE, SIDE)])
    write_labels(folder, "segformer", "segformer.onnx", labels)


def write_depths(root, name, onnx, depths, kind, side):
    """Writes a container of a depth estimator and the depth of every pixel; `side` is that of an input of dynamic size."""
    folder = imported(root, "depth")
    write_container(folder / f"{name}.zip", onnx, "depth_estimator", "depth_estimation")
    depths = depths.detach().numpy()
    assert depths.std() > 0.01 * abs(depths).max() and (depths == 0).mean() < 0.5, f"{name} predicts one depth only"
    rows = [[round(float(depth), 5) for depth in row] for row in depths]
    expected = {"image": list(reversed(depths.shape)), "kind": kind, "size": side, "depths": rows}
    (folder / f"{name}.json").write_text(json.dumps(expected) + "\n")


def resized(width, height, to):
    """The image in 0 to 1, resized to `to` (width, height) as our preprocessing does: bilinear, without antialiasing."""
    levels = torch.from_numpy(image(width, height).astype(np.float32).transpose(2, 0, 1)[None] / 255)
    return torch.nn.functional.interpolate(levels, tuple(reversed(to)), mode="bilinear", align_corners=False)


def depth_estimators(folder):
    """Depth estimators of transformers and Ultralytics."""
    import yaml
    from transformers import (
        BeitConfig,
        DepthAnythingConfig,
        DepthAnythingForDepthEstimation,
        Dinov2Config,
        DPTConfig,
        DPTForDepthEstimation,
        DPTImageProcessor,
        GLPNConfig,
        GLPNForDepthEstimation,
        GLPNImageProcessor,
        ZoeDepthConfig,
        ZoeDepthForDepthEstimation,
        ZoeDepthImageProcessor,
    )
    from transformers.models.depth_anything import modeling_depth_anything
    from transformers.models.dpt.image_processing_dpt import get_resize_output_image_size
    from ultralytics import YOLO

    imagenet = [0.485, 0.456, 0.406], [0.229, 0.224, 0.225]
    signed = [0.5] * 3, [0.5] * 3
    stages = ["stage1", "stage2", "stage3", "stage4"]
    small = {"hidden_size": 16, "num_hidden_layers": 4, "num_attention_heads": 2, "intermediate_size": 16}
    neck = {"neck_hidden_sizes": [8, 8, 8, 8], "fusion_hidden_size": 8}
    dpt = DPTConfig(image_size=64, patch_size=16, backbone_out_indices=[0, 1, 2, 3], **small, **neck)
    backbone = {"num_hidden_layers": 4, "num_attention_heads": 2, "hidden_size": 16, "mlp_ratio": 1}
    dino = Dinov2Config(image_size=56, patch_size=14, out_features=stages, apply_layernorm=True, reshape_hidden_states=False, **backbone)
    anything = {"backbone_config": dino, "reassemble_hidden_size": 16, "head_hidden_size": 8, **neck}
    glpn = GLPNConfig(
        depths=[1, 1, 1, 1], hidden_sizes=[8, 8, 16, 16], num_attention_heads=[1, 1, 2, 2], decoder_hidden_size=8, mlp_ratios=[1] * 4
    )
    beit = BeitConfig(image_size=64, patch_size=16, out_features=stages, reshape_hidden_states=False, use_relative_position_bias=True, **small)
    zoe = ZoeDepthConfig(
        backbone_config=beit, bottleneck_features=8, bin_embedding_dim=8, num_relative_features=8, num_attractors=[4, 2, 2, 1],
        bin_configurations=[{"n_bins": 8, "min_depth": 0.001, "max_depth": 10.0, "name": "nyu"}], **neck,
    )
    relative, metric = "inverse_relative", "metric"
    cases = [
        # Name, network, image processor, mean and deviation, width and height of the input (a side if dynamic), quantity.
        ("dpt", DPTForDepthEstimation(dpt), DPTImageProcessor(), signed, (64, 64), relative),
        ("dpt_dynamo", DPTForDepthEstimation(dpt), DPTImageProcessor(), signed, (64, 64), relative),
        ("depth_anything", DepthAnythingForDepthEstimation(DepthAnythingConfig(**anything)), DPTImageProcessor(), imagenet, 56, relative),
        (
            "depth_anything_metric",
            DepthAnythingForDepthEstimation(DepthAnythingConfig(depth_estimation_type="metric", max_depth=10, **anything)),
            DPTImageProcessor(), imagenet, (70, 56), metric,
        ),
        ("glpn", GLPNForDepthEstimation(glpn), GLPNImageProcessor(), ([0] * 3, [1] * 3), (64, 64), metric),
        ("zoe_depth", ZoeDepthForDepthEstimation(zoe), ZoeDepthImageProcessor(do_pad=False), signed, (64, 64), metric),
    ]
    width, height = 45, 36
    for name, model, processor, (mean, deviation), size, kind in cases:
        randomise(model, 3, density=1.0)
        if name.startswith("dpt"):
            # Depths beyond the rectifier at the end.
            model.head.head[4].bias.data.fill_(120.0)

        class Depth(torch.nn.Module):
            def __init__(self, inner):
                super().__init__()
                self.inner = inner

            def forward(self, pixel_values):
                return self.inner(pixel_values=pixel_values, return_dict=True).predicted_depth

        side, export = None, {"opset_version": 17, "dynamo": False}
        if isinstance(size, int):
            side = size
            target = get_resize_output_image_size(torch.zeros(3, height, width), (side, side), True, 14)
            size = target.width, target.height
            export["dynamic_axes"] = {"pixel_values": {2: "height", 3: "width"}, "predicted_depth": {1: "height", 2: "width"}}
            # The head interpolates to `int(...)` of traced sides, which would fix them in the file.
            modeling_depth_anything.int = lambda traced: traced
        if name.endswith("dynamo"):
            export = {"dynamo": True, "external_data": False}
        pixels = (resized(width, height, size) - torch.tensor(mean)[:, None, None]) / torch.tensor(deviation)[:, None, None]
        names = {"input_names": ["pixel_values"], "output_names": ["predicted_depth"]}
        # Dynamic sizes are exported at another size than the one that is compared.
        example = pixels if side is None else torch.zeros(1, 3, 70, 84)
        # The exporter restores the mode of the outer module, in the inner ones too.
        model = Depth(model).eval()
        torch.onnx.export(model, (example,), f"{name}.onnx", **names, **export)
        with torch.no_grad():
            found = type("Found", (), {"predicted_depth": model(pixels)})()
        [processed] = processor.post_process_depth_estimation(found, target_sizes=[(height, width)])
        write_depths(folder, name, f"{name}.onnx", processed["predicted_depth"], kind, side)

    layers = [[-1, 1, "Conv", [16, 3, 2]]] * 3 + [[-1, 1, "Conv", [16, 3, 2]], [-1, 1, "Conv", [16, 3, 2]]]
    spec = {"nc": 1, "scales": {"n": [1, 1, 1024]}, "backbone": layers, "head": [[[2, 3, 4], 1, "Depth", [24]]]}
    Path("yolo26n-depth-tiny.yaml").write_text(yaml.safe_dump(spec))
    model = YOLO("yolo26n-depth-tiny.yaml", task="depth")
    randomise(model.model, 13)
    onnx = model.export(format="onnx", imgsz=SIDE, simplify=False, opset=17)
    depths = outputs_of(onnx, images=resized(width, height, (SIDE, SIDE)).numpy())[0]
    depths = torch.nn.functional.interpolate(torch.from_numpy(depths), (height, width), mode="bilinear", align_corners=True)
    write_depths(folder, "yolo_depth", onnx, depths[0, 0], metric, None)


def mmpose_codecs():
    """MMPose's functions that decode outputs, without mmcv, which the rest of the package needs."""
    import importlib.util

    [path] = [Path(entry) / "mmpose/codecs/utils" for entry in sys.path if (Path(entry) / "mmpose/codecs/utils").is_dir()]
    spec = importlib.util.spec_from_file_location("codecs_utils", path / "__init__.py", submodule_search_locations=[str(path)])
    module = importlib.util.module_from_spec(spec)
    sys.modules["codecs_utils"] = module
    spec.loader.exec_module(module)
    return module


def write_top_down(root, name, onnx, size, boxes, poses, **params):
    """Writes a container and its poses: for each box (left, top, width, height) its keypoints x, y, score in image pixels."""
    folder = imported(root, "pose")
    write_container(folder / f"{name}.zip", onnx, "top_down_pose_estimator", "pose_estimation")
    poses = [[[round(float(value), 5) for value in point] for point in points] for points in poses]
    expected = {"image": size, "params": params, "boxes": boxes, "poses": poses}
    (folder / f"{name}.json").write_text(json.dumps(expected) + "\n")


def top_down_poses(folder):
    """Networks of one person's crop: SimCC and heatmaps by rtmlib and MMPose, ViTPose by transformers."""
    from rtmlib import RTMPose
    from transformers import VitPoseConfig, VitPoseForPoseEstimation, VitPoseImageProcessor
    from transformers.models.vitpose.modeling_vitpose import VitPoseEstimatorOutput
    from transformers.models.vitpose_backbone import VitPoseBackboneConfig

    codecs = mmpose_codecs()
    width, height = 90, 120
    side = np.array([48, 64])
    # Crops of OpenCV are exact for floats where positions are multiples of 1/32 of a pixel: a crop's side is 1.5 times the input's.
    boxes = [[43.5 - 28.8, 60 - 38.4, 57.6, 76.8], [10 - 28.8, 20.25 - 20, 57.6, 40.0]]
    corners = [[left, top, left + across, top + down] for left, top, across, down in boxes]

    class Columns(torch.nn.Module):
        def __init__(self):
            super().__init__()
            self.maps = torch.nn.Conv2d(3, 5, 8, 8)
            self.x, self.y = torch.nn.Linear(48, 96), torch.nn.Linear(48, 128)

        def forward(self, pixels):
            maps = self.maps(pixels).flatten(2)
            return self.x(maps), self.y(maps)

    class Maps(torch.nn.Sequential):
        def __init__(self):
            super().__init__(torch.nn.Conv2d(3, 8, 4, 4), torch.nn.ReLU(), torch.nn.Conv2d(8, 17, 3, padding=1))

    for name, model, outputs in [("simcc", Columns(), ["simcc_x", "simcc_y"]), ("heatmaps", Maps(), ["output"])]:
        randomise(model, 5)
        example = torch.zeros(1, 3, 64, 48)
        torch.onnx.export(
            model.eval(), (example,), f"{name}.onnx", input_names=["input"], output_names=outputs, opset_version=17, dynamo=False
        )
        rtmpose = RTMPose(f"{name}.onnx", model_input_size=(48, 64))
        poses = []
        for box in corners:
            crop, center, scale = rtmpose.preprocess(image(width, height).astype(np.float32), box)
            found = rtmpose.inference(crop)
            if name == "simcc":
                points, _ = rtmpose.postprocess(found, center, scale)
                # rtmlib averages the scores of column and row; MMPose has their minimum.
                _, scores = codecs.get_simcc_maximum(*found)
            else:
                points, scores = codecs.get_heatmap_maximum(found[0][0])
                points = codecs.refine_keypoints(points[None], found[0][0]) * 4
                points = points / side * scale + center - scale / 2
                scores = scores[None]
            poses.append(np.concatenate([points[0], scores[0][:, None]], 1))
        given = {} if name == "simcc" else {"layout": "heatmaps", "colour": "rgb", "levels": "imagenet"}
        write_top_down(folder, name, f"{name}.onnx", [width, height], boxes, poses, **given)

    backbone = VitPoseBackboneConfig(
        image_size=[64, 48], hidden_size=16, num_hidden_layers=1, num_attention_heads=2, mlp_ratio=1, out_indices=[1]
    )
    model = VitPoseForPoseEstimation(VitPoseConfig(backbone_config=backbone, num_labels=17))
    randomise(model, 7, density=1.0)
    processor = VitPoseImageProcessor(size={"width": 48, "height": 64})

    class Heatmaps(torch.nn.Module):
        def __init__(self, inner):
            super().__init__()
            self.inner = inner

        def forward(self, pixel_values):
            return self.inner(pixel_values, return_dict=True).heatmaps

    boxes = [[20.0, 15.5, 40.0, 80.0], [-10.0, 30.0, 60.0, 40.0]]
    # Floats, so that the crop is not rounded to whole levels.
    levels = torch.from_numpy(image(width, height).transpose(2, 0, 1).astype(np.float32))
    pixels = processor([levels], [boxes], return_tensors="pt")["pixel_values"]
    model = Heatmaps(model).eval()
    names = {"input_names": ["pixel_values"], "output_names": ["heatmaps"]}
    torch.onnx.export(model, (pixels[:1],), "vitpose.onnx", opset_version=17, dynamo=False, **names)
    with torch.no_grad():
        outputs = VitPoseEstimatorOutput(heatmaps=torch.cat([model(crop[None]) for crop in pixels]))
    [found] = processor.post_process_pose_estimation(outputs, [boxes])
    poses = [torch.cat([pose["keypoints"], pose["scores"][:, None]], 1) for pose in found]
    write_top_down(folder, "vitpose", "vitpose.onnx", [width, height], boxes, poses)


def main():
    folder = Path(sys.argv[1]).resolve()
    wanted = sys.argv[2:]
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        for package in (ultralytics, yolox, torchvision, transformers, segmenters, depth_estimators, top_down_poses):
            if not wanted or package.__name__ in wanted:
                package(folder)


if __name__ == "__main__":
    main()
