"""OpenDR's perception.activity_recognition."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

_TIMESERIES = "opendr._upstream.video_datasets"

MODULES: dict[str, dict[str, Home]] = {
    "continual_transformer_encoder.continual_transformer_encoder_learner": {"CoTransEncLearner": HERE},
    "cox3d.cox3d_learner": {"CoX3DLearner": HERE},
    "datasets.dummy_timeseries_dataset": {"DummyTimeseriesDataset": _TIMESERIES},
    "datasets.kinetics": {
        "CLASSES": Absent("`classes` of the loaded learner has the class names"),
        "KineticsDataset": "opendr._upstream.video_datasets",
    },
    "x3d.x3d_learner": {"X3DLearner": HERE},
}

_FIT = "dataset val_dataset epochs steps>max_steps"
_INIT = (
    "lr iters batch_size optimizer lr_schedule backbone network_head checkpoint_after_iter checkpoint_load_iter"
    " temp_path device loss weight_decay momentum drop_last pin_memory num_workers seed num_classes"
)

LEARNERS = {
    "X3DLearner": Learner(
        init=_INIT,
        infer="batch>video",
        fit=_FIT,
        eval="dataset steps>limit",
        optimize="do_constant_folding!onnx",
        download="path model_names",
        models="xs s m l",
        folder="x3d_{model_names=s}.pyth",
        demos="online_recognition",
        differs=(
            "`infer` returns one `Category` per clip, with the scores of all classes in `probabilities`",
            "trained on stick figures of JHMDB's actions, not on Kinetics",
        ),
    ),
    "CoX3DLearner": Learner(
        init=f"{_INIT} temporal_window_size",
        infer="batch>image",
        fit=_FIT,
        eval="dataset steps>limit",
        optimize="do_constant_folding!onnx",
        download="path model_names",
        models="xs s m l",
        folder="x3d_{model_names=s}.pyth",
        demos="online_recognition",
        differs=("as X3DLearner; images are not normalised before `infer`",),
    ),
    "CoTransEncLearner": Learner(
        init="lr iters batch_size optimizer lr_schedule network_head num_layers input_dims hidden_dims sequence_len"
        " num_heads dropout num_classes positional_encoding_learned checkpoint_after_iter checkpoint_load_iter temp_path"
        " device loss weight_decay momentum drop_last pin_memory num_workers seed",
        infer="x>timeseries",
        fit=_FIT,
        eval="dataset steps>limit",
        optimize="do_constant_folding!onnx",
        demos="–",
        differs=(
            "a step is a Timeseries of one row, `[1, input_dims]`; the first one already yields a prediction",
            "there is no pretrained model, as in OpenDR",
        ),
    ),
}
