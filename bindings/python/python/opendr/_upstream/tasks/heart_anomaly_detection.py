"""OpenDR's perception.heart_anomaly_detection."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

_DATA: dict[str, Home] = {
    "Dataset": "opendr._upstream.signal_datasets",
    "get_AF_dataset": Absent('use ExternalDataset(path, "wfdb"), which reads PhysioNet\'s records'),
}

MODULES: dict[str, dict[str, Home]] = {
    "": {"get_AF_dataset": _DATA["get_AF_dataset"]},
    "attention_neural_bag_of_feature.algorithm.data": _DATA,
    "attention_neural_bag_of_feature.attention_neural_bag_of_feature_learner": {
        "AttentionNeuralBagOfFeatureLearner": HERE
    },
    "gated_recurrent_unit.algorithm.data": _DATA,
    "gated_recurrent_unit.gated_recurrent_unit_learner": {
        "GatedRecurrentUnitLearner": HERE,
        "get_AF_dataset": _DATA["get_AF_dataset"],
    },
}

_FIT = "train_set>dataset val_set>val_dataset test_set!test class_weight logging_path silent verbose"
_ENDS = (
    "lr_scheduler!scheduler optimizer weight_decay dropout iters batch_size checkpoint_after_iter checkpoint_load_iter"
    " temp_path device test_mode"
)
_DIFFERS = (
    "series are `[time, channels]`, as Timeseries says",
    "trained on the beats of ECG5000 (140 samples, two classes); `download` loads the same model for every `fold_idx`",
)

LEARNERS = {
    "GatedRecurrentUnitLearner": Learner(
        init=f"in_channels series_length n_class recurrent_unit {_ENDS}",
        infer="series>timeseries",
        fit=_FIT,
        eval="dataset silent verbose",
        download="path fold_idx",
        folder="",
        loads=True,
        demos="demo",
        differs=_DIFFERS,
    ),
    "AttentionNeuralBagOfFeatureLearner": Learner(
        init=f"in_channels series_length n_class n_codeword quantization_type attention_type {_ENDS}",
        infer="series>timeseries",
        fit=_FIT,
        eval="dataset silent verbose",
        download="path fold_idx",
        folder="",
        loads=True,
        demos="demo",
        differs=_DIFFERS,
    ),
}
