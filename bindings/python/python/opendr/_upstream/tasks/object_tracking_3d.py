"""OpenDR's perception.object_tracking_3d."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

_DATASETS = "opendr._upstream.space_datasets"
_PAIRS = Absent('give fit of ObjectTracking3DVpitLearner an ExternalDataset(path, "kitti_tracking")')

MODULES: dict[str, dict[str, Home]] = {
    "ab3dmot.object_tracking_3d_ab3dmot_learner": {"ObjectTracking3DAb3dmotLearner": HERE},
    "datasets.kitti_siamese_tracking": {
        "SiameseTrackingDatasetIterator": _PAIRS,
        "SiameseTripletTrackingDatasetIterator": _PAIRS,
    },
    "datasets.kitti_tracking": {
        "KittiTrackingDatasetIterator": _DATASETS,
        "LabeledTrackingPointCloudsDatasetIterator": _DATASETS,
    },
    "single_object_tracking.vpit.draw": {
        "draw_point_cloud_bev": Absent("`opendr data view` draws scans and their boxes from above"),
    },
    "single_object_tracking.vpit.vpit_object_tracking_3d_learner": {"ObjectTracking3DVpitLearner": HERE},
}

LEARNERS = {
    "ObjectTracking3DAb3dmotLearner": Learner(
        init="device max_staleness min_updates state_dimensions measurement_dimensions state_transition_matrix"
        " measurement_function_matrix covariance_matrix process_uncertainty_matrix iou_threshold",
        infer="bounding_boxes_3d_list>boxes_3d",
        fit="dataset val_dataset logging_path silent verbose",
        eval="dataset logging_path!log silent verbose count>limit",
        mixin="opendr._upstream.learners.tracking:BoxesInSpace",
        ready=True,
        demos="benchmark_ab3dmot",
        differs=(
            '`eval` takes an ExternalDataset(path, "kitti_tracking"), or pairs of boxes and annotations by frame',
        ),
    ),
    "ObjectTracking3DVpitLearner": Learner(
        init="model_config_path lr optimizer lr_schedule checkpoint_after_iter checkpoint_load_iter temp_path device"
        " tanet_config_path optimizer_params!optimizer lr_schedule_params!scheduler feature_blocks window_influence"
        " score_upscale rotation_penalty rotation_step rotations_count rotation_interpolation target_size search_size"
        " context_amount target_feature_merge_scale loss_function r_pos!boxes augment augment_rotation"
        " train_pseudo_image search_type target_type bof_mode bof_training_steps extrapolation_mode"
        " offset_interpolation vertical_offset_interpolation min_top_score overwrite_strides target_features_mode"
        " upscaling_mode regress_vertical_position regression_training_isolation vertical_regressor_type"
        " vertical_regressor_kwargs iters backbone batch_size threshold scale",
        infer="point_cloud frame id draw!draw",
        fit="dataset steps>max_steps val_dataset refine_weight!weight ground_truth_annotations!truth logging_path"
        " silent verbose model_dir>out image_shape!shape evaluate!evaluate debug!log load_optimizer!scratch",
        eval="dataset ground_truth_annotations!truth logging_path!log silent verbose image_shape!shape count>limit",
        optimize="do_constant_folding!onnx",
        download="model_name path server_url>url",
        load="path verbose backbone!whole full!whole",
        methods={"init": ""},
        mixin="opendr._upstream.learners.tracking:Vpit",
        same={"optimizer": {"adam_optimizer": "adam"}},
        instead={"lr_schedule": "exponential_decay_learning_rate"},
        models="pointpillars_car_xyres_16 tanet_car_xyres_16",
        folder="{model_name=pointpillars_car_xyres_16}",
        demos="–",
        differs=("one network, PointPillars, trained on simulated drives",),
    ),
}
