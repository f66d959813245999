"""OpenDR's perception.pose_estimation."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

_DRAWING = "opendr._drawing"

MODULES: dict[str, dict[str, Home]] = {
    "": {"draw": _DRAWING, "get_bbox": _DRAWING},
    "hr_pose_estimation.high_resolution_learner": {"HighResolutionPoseEstimationLearner": HERE},
    "lightweight_open_pose.algorithm.datasets.coco": {
        "CocoTrainDataset": "opendr._upstream.pose_datasets",
        "CocoValDataset": "opendr._upstream.pose_datasets",
    },
    "lightweight_open_pose.filtered_pose": {
        "FilteredPose": Absent("infer(img, track=True, smooth=True) of LightweightOpenPoseLearner smooths poses")
    },
    "lightweight_open_pose.lightweight_open_pose_learner": {"LightweightOpenPoseLearner": HERE},
    "lightweight_open_pose.utilities": {
        "draw": _DRAWING,
        "get_bbox": _DRAWING,
        "track_poses": Absent("infer(img, track=True) of LightweightOpenPoseLearner assigns identities to poses"),
    },
}

_EVAL = "dataset silent verbose use_subset subset_size"
_FIT = (
    "dataset val_dataset logging_path logging_flush_secs!flush silent verbose epochs use_val_subset!subset"
    " val_subset_size!subset images_folder_name>split annotations_filename!part val_images_folder_name>val_split"
    " val_annotations_filename!part"
)

LEARNERS = {
    "LightweightOpenPoseLearner": Learner(
        init="lr epochs batch_size device backbone lr_schedule temp_path checkpoint_after_iter checkpoint_load_iter"
        " val_after log_after mobilenet_use_stride mobilenetv2_width shufflenet_groups num_refinement_stages"
        " batches_per_iter experiment_name num_workers weights_only output_name multiscale scales visualize base_height"
        " img_mean img_scale pad_value half_precision",
        infer="img>image upsample_ratio track smooth",
        fit=_FIT,
        eval=f"{_EVAL} images_folder_name>split annotations_filename!part",
        optimize="do_constant_folding!onnx",
        instead={"backbone": "mobilenet mobilenetv2 shufflenet"},
        folder="openpose_default",
        demos="inference, eval",
        differs=(
            "`download(mode=\"test_data\")` is not available: get COCO's images from COCO, in COCO's folders",
            "`eval` returns `map`, `map50`, ... by name; `confidence` of a pose is between 0 and 1",
            "one backbone, MobileNetV1 0.5 by default",
        ),
    ),
    "HighResolutionPoseEstimationLearner": Learner(
        init="device backbone temp_path mobilenet_use_stride mobilenetv2_width!model shufflenet_groups"
        " num_refinement_stages!model batches_per_iter!training base_height first_pass_height second_pass_height method"
        " percentage_around_crop heatmap_threshold experiment_name num_workers!training weights_only output_name"
        " multiscale scales visualize img_mean img_scale pad_value half_precision",
        infer="img>image upsample_ratio stride!stride track smooth multiscale",
        fit=_FIT.replace("epochs", "epochs!training"),
        eval="dataset silent verbose use_subset subset_size upsample_ratio images_folder_name>split"
        " annotations_filename!part",
        optimize="do_constant_folding!onnx",
        download="path mode verbose url image_resolution!images",
        methods={"eval_adaptive": "", "infer_adaptive": ""},
        mixin="opendr._upstream.learners.people:HighResolutionPoses",
        folder="openpose_default",
        demos="inference, eval",
        differs=("`infer` returns only poses, without heatmap and bounds",),
    ),
}
