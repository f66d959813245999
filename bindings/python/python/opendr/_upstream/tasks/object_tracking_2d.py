"""OpenDR's perception.object_tracking_2d."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

_DATASETS = "opendr._upstream.tracking_datasets"

MODULES: dict[str, dict[str, Home]] = {
    "datasets.market1501_dataset": {"Market1501Dataset": _DATASETS, "Market1501DatasetIterator": _DATASETS},
    "datasets.mot_dataset": {
        "MotDataset": _DATASETS,
        "MotDatasetIterator": _DATASETS,
        "RawMotDatasetIterator": _DATASETS,
        "RawMotWithDetectionsDatasetIterator": _DATASETS,
    },
    "datasets.otb_dataset": {"OTBTrainDataset": Absent("SiamRPNLearner tracks any object without training")},
    "deep_sort.object_tracking_2d_deep_sort_learner": {"ObjectTracking2DDeepSortLearner": HERE},
    "fair_mot.object_tracking_2d_fair_mot_learner": {"ObjectTracking2DFairMotLearner": HERE},
    "siamrpn.siamrpn_learner": {"SiamRPNLearner": HERE},
}

LEARNERS = {
    "ObjectTracking2DFairMotLearner": Learner(
        init="lr iters batch_size optimizer lr_schedule backbone network_head checkpoint_after_iter"
        " checkpoint_load_iter temp_path device threshold scale lr_step head_conv ltrb num_classes reg_offset gpus"
        " num_workers mse_loss reg_loss dense_wh cat_spec_wh reid_dim norm_wh wh_weight off_weight id_weight num_epochs"
        " hm_weight down_ratio max_objs track_buffer image_mean image_std frame_rate min_box_area"
        " use_pretrained_backbone",
        infer="batch>image frame_ids img_size!size",
        fit="dataset val_dataset val_epochs!training logging_path silent verbose train_split_paths!part"
        " val_split_paths!part resume_optimizer!training nID!training",
        eval="dataset val_split_paths!part logging_path!log silent verbose",
        optimize="do_constant_folding!onnx img_size!size optimizable_dcn_v2!dcn",
        download="model_name path server_url>url",
        mixin="opendr._upstream.learners.tracking:NumberedFrames",
        models="crowdhuman_dla34 fairmot_dla34",
        folder="{model_name=fairmot_dla34}",
        demos="benchmark_fair_mot",
        differs=("it uses NanoDet and ByteTrack for every `model_name`; it cannot be trained",),
    ),
    "ObjectTracking2DDeepSortLearner": Learner(
        init="lr iters batch_size optimizer checkpoint_after_iter checkpoint_load_iter temp_path device max_dist"
        " min_confidence nms_max_overlap max_iou_distance max_age n_init nn_budget",
        fit="dataset epochs!training val_dataset val_epochs!training logging_path silent verbose"
        " train_transforms!training val_transforms!training",
        eval="dataset logging_path!log silent verbose",
        optimize="do_constant_folding!onnx img_size!size",
        download="model_name path server_url>url",
        mixin="opendr._upstream.learners.tracking:DeepSort",
        models="deep_sort",
        folder="{model_name=deep_sort}",
        demos="benchmark_deep_sort",
        differs=("an `ImageWithDetections` is one input, an image and its boxes are two; it cannot be trained",),
    ),
    "SiamRPNLearner": Learner(
        init="device n_epochs num_workers warmup_epochs lr weight_decay momentum cls_weight loc_weight batch_size"
        " temp_path",
        infer="img>image init_box",
        fit="dataset log_interval!training n_gpus!training val_dataset logging_path silent verbose",
        mixin="opendr._upstream.learners.tracking:SingleObject",
        download="path mode verbose url overwrite!overwrite",
        folder="siamrpn_opendr",
        demos="inference, eval",
        differs=(
            "coordinates are floats: OpenCV needs `int(box.left)`",
            "a stream that begins with one box returns one annotation per frame, else a list; it cannot be trained",
            "`download` has no videos; there is no format of OTB",
        ),
    ),
}
