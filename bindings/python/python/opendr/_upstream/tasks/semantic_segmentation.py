"""OpenDR's perception.semantic_segmentation."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Home, Learner, Runs

MODULES: dict[str, dict[str, Home]] = {
    "bisenet.CamVid": {"CamVidDataset": "opendr._upstream.segmentation_datasets"},
    "bisenet.bisenet_learner": {"BisenetLearner": HERE},
    "yolov8_seg.yolov8_seg_learner": {
        "YOLOv8SegLearner": Runs("opendr.perception.object_detection_2d:ImportedDetectorLearner"),
    },
}

LEARNERS = {
    "YOLOv8SegLearner": Learner(
        init="model_name!file model_path>path device temp_path",
        infer=(
            "img>image conf_thres>threshold iou_thres>iou_threshold image_size!size half_prec!half agnostic_nms!classwise"
            " classes!filter no_mismatch!file verbose!log show!draw"
        ),
        mixin="opendr._upstream.learners.own_networks:SegmentedObjects",
        methods={
            "download": "export your network to ONNX and give load the file; DeeplabLearner has weights",
            "fit": "train your network in its own tool; BisenetLearner trains here",
            "get_bboxes": "",
            "get_classes": "",
            "get_visualization": "",
        },
        demos="–",
        differs=(
            "`model_path` is your network, exported to ONNX; no weights are downloaded by `model_name`",
            "class indices in the map begin at 1; 0 is the background",
        ),
    ),
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
