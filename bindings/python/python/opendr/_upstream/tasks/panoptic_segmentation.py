"""OpenDR's perception.panoptic_segmentation."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Home, Learner

_DATASETS = "opendr._upstream.segmentation_datasets"
_NAMES: dict[str, Home] = dict.fromkeys(("CityscapesDataset", "KittiDataset", "SemanticKittiDataset"), _DATASETS)
_INIT = (
    "config_file lr iters batch_size optimizer lr_schedule momentum weight_decay optimizer_config{}"
    " checkpoint_after_iter temp_path device num_workers seed"
)

MODULES: dict[str, dict[str, Home]] = {
    "datasets": _NAMES,
    "datasets.cityscapes": {"CityscapesDataset": _DATASETS},
    "datasets.kitti": {"KittiDataset": _DATASETS},
    "datasets.semantic_kitti": {"SemanticKittiDataset": _DATASETS},
    "efficient_lps.efficient_lps_learner": {"EfficientLpsLearner": HERE},
    "efficient_ps.efficient_ps_learner": {"EfficientPsLearner": HERE},
}

LEARNERS = {
    "EfficientPsLearner": Learner(
        init=_INIT.format(""),
        infer="batch>image return_raw_logits!raw",
        eval="dataset print_results>verbose",
        download="path mode trained_on",
        methods={"visualize": ""},
        mixin="opendr._upstream.learners.scenes:PanopticPictures",
        models="cityscapes kitti",
        folder="model_{trained_on=cityscapes}.pth",
        modes={"model": "pretrained"},
        demos="example_usage",
        differs=(
            "it fuses DeepLab and BodyPix, with COCO's classes; it cannot be trained",
            '`eval` takes an ExternalDataset(path, "coco_panoptic")',
        ),
    ),
    "EfficientLpsLearner": Learner(
        init=_INIT.format("!optimizer"),
        infer="batch>point_cloud return_raw_logits!raw projected",
        eval="dataset print_results>verbose",
        download="path mode trained_on",
        methods={"visualize": "`opendr data view` draws scans from above"},
        same={"optimizer": {"SGD": "sgd"}},
        models="semantickitti",
        folder="model_{trained_on=semantickitti}.pth",
        modes={"model": "pretrained"},
        demos="example_usage",
        differs=(
            "trained on simulated streets; SemanticKittiDataset has scans with classes, but `eval` does not take it",
        ),
    ),
}
