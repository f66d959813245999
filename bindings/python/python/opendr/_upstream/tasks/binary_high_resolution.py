"""OpenDR's perception.binary_high_resolution."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "": {"visualize": "opendr._upstream.drawing"},
    "binary_high_resolution_learner": {"BinaryHighResolutionLearner": HERE},
    "utils.high_resolution_loader": {"HighResolutionDataset": "opendr._upstream.segmentation_datasets"},
    "utils.utils": {"visualize": "opendr._upstream.drawing"},
}

LEARNERS = {
    "BinaryHighResolutionLearner": Learner(
        init="lr iters batch_size optimizer temp_path device weight_decay momentum num_workers architecture",
        infer="img>image",
        fit="dataset silent verbose",
        eval="dataset silent verbose",
        optimize="do_constant_folding!onnx",
        mixin="opendr._upstream.learners.scenes:HighResolution",
        demos="train_eval, inference",
        differs=("`infer` returns the map and a `Category` for the whole image; `download` has no demo data",),
    ),
}
