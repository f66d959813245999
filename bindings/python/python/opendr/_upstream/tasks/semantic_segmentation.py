"""OpenDR's perception.semantic_segmentation."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "bisenet.CamVid": {"CamVidDataset": "opendr._upstream.segmentation_datasets"},
    "bisenet.bisenet_learner": {"BisenetLearner": HERE},
    "yolov8_seg.yolov8_seg_learner": {
        "YOLOv8SegLearner": Absent(
            "use ImportedDetectorLearner with an ONNX export, which returns masks, or DeeplabLearner for classes"
        )
    },
}

LEARNERS = {
    "BisenetLearner": Learner(
        init="lr iters batch_size optimizer temp_path checkpoint_after_iter checkpoint_load_iter device val_after"
        " weight_decay momentum drop_last pin_memory num_workers num_classes crop_height crop_width context_path",
        infer="img>image",
        fit="dataset val_dataset silent verbose",
        eval="dataset silent verbose",
        folder="",
        modes={"testingImage": "images"},
        picture="test1.png",
        demos="inference, train, eval",
        differs=(
            "trained on drawn streets; with `full_size`, `infer` returns the map in the size of the image",
            "CamVid is available from its publisher only",
        ),
    ),
}
