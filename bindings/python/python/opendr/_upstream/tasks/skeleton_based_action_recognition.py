"""OpenDR's perception.skeleton_based_action_recognition."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

_FEEDER = Absent('use ExternalDataset(path, "skeleton")')
_STREAMS = {
    "multi_stream_eval": "add the `probabilities` of two learners and evaluate them with opendr.metrics",
}
_FIT = (
    "dataset val_dataset logging_path silent verbose momentum nesterov!nesterov weight_decay"
    " train_data_filename!names train_labels_filename!names val_data_filename!names val_labels_filename!names"
    " skeleton_data_type!joint"
)
_EVAL = (
    "val_dataset>dataset val_loader!loader epoch!epoch silent verbose val_data_filename!names"
    " val_labels_filename!names skeleton_data_type!joint save_score!csv wrong_file!csv result_file!csv show_topk!csv"
)
_INIT = (
    "lr batch_size optimizer_name lr_schedule checkpoint_after_iter checkpoint_load_iter temp_path device num_workers"
    " epochs experiment_name device_ind val_batch_size drop_after_epoch start_epoch dataset_name num_class num_point"
    " num_person in_channels graph_type"
)

MODULES: dict[str, dict[str, Home]] = {
    "algorithm.datasets.feeder": {"Feeder": _FEEDER},
    "algorithm.datasets.kinetics_feeder": {"KineticsFeeder": _FEEDER},
    "algorithm.models.stbln": {"STBLN": Absent('use SpatioTemporalGCNLearner(method_name="stbln")')},
    "algorithm.models.tagcn": {"TAGCN": Absent('use SpatioTemporalGCNLearner(method_name="tagcn")')},
    "continual_stgcn_learner": {"CoSTGCNLearner": HERE},
    "progressive_spatio_temporal_gcn_learner": {"ProgressiveSpatioTemporalGCNLearner": HERE},
    "spatio_temporal_gcn_learner": {"SpatioTemporalGCNLearner": HERE},
}

LEARNERS = {
    "SpatioTemporalGCNLearner": Learner(
        init=f"{_INIT} method_name stbln_symmetric num_frames num_subframes",
        infer="SkeletonSeq_batch>skeleton_sequence",
        fit=_FIT,
        eval=_EVAL,
        optimize="do_constant_folding!onnx",
        download="path method_name mode verbose url file_name",
        load="path model_name verbose",
        methods=_STREAMS,
        models="stgcn_nturgbd stgcn_kinetics",
        folder="{file_name=stgcn_nturgbd}",
        demos="–",
        differs=(
            "trained on JHMDB's skeletons; data are in SPLIT_data.npy and SPLIT_label.npy",
            "the model is of `stgcn`; `tagcn` and `stbln` are trained first",
        ),
    ),
    "ProgressiveSpatioTemporalGCNLearner": Learner(
        init=f"{_INIT} blocksize numblocks numlayers topology layer_threshold block_threshold",
        infer="skeletonseq_batch>skeleton_sequence",
        fit=_FIT,
        eval=_EVAL,
        optimize="do_constant_folding!onnx",
        load="path model_name verbose",
        methods={**_STREAMS, "network_builder": "call `fit`, which grows the network while `topology` is empty"},
        demos="–",
        differs=(
            "`fit` grows the network where `topology` is empty; there is no pretrained model",
            "data are in SPLIT_data.npy and SPLIT_label.npy",
        ),
    ),
    "CoSTGCNLearner": Learner(
        init="lr iters batch_size optimizer lr_schedule backbone network_head checkpoint_after_iter"
        " checkpoint_load_iter temp_path device loss weight_decay momentum drop_last pin_memory num_workers seed"
        " num_classes num_point num_person in_channels graph_type sequence_len",
        infer="batch>skeleton_sequence",
        fit="dataset val_dataset epochs steps>max_steps",
        eval="dataset steps>limit",
        optimize="do_constant_folding!onnx",
        download="path method_name mode verbose url file_name",
        models="costgcn_ntu60_xview_joint.ckpt",
        folder="{file_name=costgcn_ntu60_xview_joint.ckpt}",
        demos="costgcn_usage_demo",
        differs=(
            "`infer` returns one `Category` per frame; trained on JHMDB's skeletons; no data are downloaded",
            "the model is of `costgcn`; `coagcn` and `costr` are trained first",
        ),
    ),
}
