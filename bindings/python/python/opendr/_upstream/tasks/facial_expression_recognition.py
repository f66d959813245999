"""OpenDR's perception.facial_expression_recognition."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

_IMAGES = "image_based_facial_emotion_estimation"
_LANDMARKS = "landmark_based_facial_expression_recognition"
_POINTS = Absent("use FaceMeshLearner of facial_landmarks for the landmarks of faces")
_EMOTIONS = Absent('use ExternalDataset(path, "imagefolder"), a folder for each emotion')

MODULES: dict[str, dict[str, Home]] = {
    f"{_IMAGES}.algorithm.utils.datasets": {"AffectNetCategorical": _EMOTIONS, "AffectNetDimensional": _EMOTIONS},
    f"{_IMAGES}.algorithm.utils.image_processing": {
        "detect_face": Absent("FacialEmotionLearner detects the face itself (`picture`)"),
    },
    f"{_IMAGES}.facial_emotion_learner": {"FacialEmotionLearner": HERE},
    f"{_LANDMARKS}.algorithm.datasets.AFEW_data_gen": {"data_normalization": _POINTS},
    f"{_LANDMARKS}.algorithm.datasets.gen_facial_muscles_data": {"gen_muscle_data": _POINTS},
    f"{_LANDMARKS}.algorithm.datasets.landmark_extractor": {"landmark_extractor": _POINTS},
    f"{_LANDMARKS}.progressive_spatio_temporal_bln_learner": {"ProgressiveSpatioTemporalBLNLearner": HERE},
    # The names that OpenDR's package and documentation also use.
    "image_processing": {"detect_face": Absent("FacialEmotionLearner detects the face itself (`picture`)")},
    "datasets": {"AffectNetCategorical": _EMOTIONS, "AffectNetDimensional": _EMOTIONS},
}

LEARNERS = {
    "FacialEmotionLearner": Learner(
        init="lr batch_size temp_path device device_ind validation_interval max_training_epoch momentum ensemble_size"
        " base_path_experiment name_experiment dimensional_finetune categorical_train base_path_to_dataset"
        " max_tuning_epoch diversify",
        infer="input_batch>image",
        optimize="do_constant_folding!onnx",
        mixin="opendr._upstream.learners.people:FacialEmotion",
        demos="inference",
        differs=(
            "`infer` returns one `Category` with the scores of all emotions, without valence and arousal",
            "it cannot be trained; `eval` takes a data set; `image_processing` has no functions: `opendr.Source` reads "
            "cameras",
        ),
    ),
    "ProgressiveSpatioTemporalBLNLearner": Learner(
        init="lr batch_size optimizer_name lr_schedule checkpoint_after_iter checkpoint_load_iter temp_path device"
        " num_workers epochs experiment_name device_indices val_batch_size drop_after_epoch start_epoch dataset_name"
        " num_class num_point num_person in_channels blocksize num_blocks num_layers topology layer_threshold"
        " block_threshold",
        infer="facial_landmarks_batch>skeleton_sequence monte_carlo_dropout!dropout mcdo_repeats!dropout",
        fit="dataset val_dataset logging_path silent verbose momentum nesterov!nesterov weight_decay"
        " monte_carlo_dropout!dropout mcdo_repeats!dropout train_data_filename!names train_labels_filename!names"
        " val_data_filename!names val_labels_filename!names",
        eval="val_dataset>dataset val_loader!loader epoch!epoch monte_carlo_dropout!dropout mcdo_repeats!dropout silent"
        " verbose val_data_filename!names val_labels_filename!names save_score!csv wrong_file!csv result_file!csv"
        " show_topk!csv",
        optimize="do_constant_folding!onnx",
        load="path model_name verbose",
        methods={"network_builder": "call `fit`, which grows the network while `topology` is empty"},
        demos="–",
        differs=("`fit` grows the network where `topology` is empty; there is no pretrained model",),
    ),
}
