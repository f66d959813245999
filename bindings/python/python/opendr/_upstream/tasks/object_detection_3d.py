"""OpenDR's perception.object_detection_3d."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Home, Learner

_DATASETS = "opendr._upstream.space_datasets"

MODULES: dict[str, dict[str, Home]] = {
    "datasets.kitti": {"KittiDataset": _DATASETS, "LabeledPointCloudsDatasetIterator": _DATASETS},
    "voxel_object_detection_3d.voxel_object_detection_3d_learner": {"VoxelObjectDetection3DLearner": HERE},
}

LEARNERS = {
    "VoxelObjectDetection3DLearner": Learner(
        init="model_config_path lr iters batch_size optimizer lr_schedule backbone network_head checkpoint_after_iter"
        " checkpoint_load_iter temp_path device threshold scale tanet_config_path optimizer_params!optimizer"
        " lr_schedule_params!scheduler",
        infer="point_clouds>point_cloud",
        fit="dataset val_dataset refine_weight!weight ground_truth_annotations!truth logging_path silent verbose"
        " model_dir>out image_shape!shape evaluate!evaluate",
        eval="dataset ground_truth_annotations!truth logging_path!log silent verbose image_shape!shape count>limit",
        optimize="do_constant_folding!onnx",
        download="model_name path server_url>url",
        same={"optimizer": {"adam_optimizer": "adam"}},
        instead={"lr_schedule": "exponential_decay_learning_rate"},
        models="pointpillars_car_xyres_16 tanet_car_xyres_16",
        folder="{model_name=pointpillars_car_xyres_16}",
        demos="voxel_object_detection_3d",
        differs=(
            "one network, PointPillars, trained on cars of simulated streets; the other classes have to be trained",
            "`eval` returns the scalars of the metric `kitti_detection` by name",
        ),
    ),
}
