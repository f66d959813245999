"""OpenDR's perception.face_recognition."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "algorithm.util.iterator": {
        "FaceRecognitionDataset": Absent('use ExternalDataset(path, "lfw") for pairs of faces'),
    },
    "face_recognition_learner": {"FaceRecognitionLearner": HERE},
}

LEARNERS = {
    "FaceRecognitionLearner": Learner(
        init="lr iters batch_size optimizer device threshold backbone network_head loss temp_path mode"
        " checkpoint_after_iter checkpoint_load_iter val_after input_size rgb_mean rgb_std embedding_size weight_decay"
        " momentum drop_last stages pin_memory num_workers seed",
        infer="img>image",
        eval="dataset num_pairs>limit silent verbose",
        optimize="do_constant_folding!onnx",
        methods={"align": "infer detects and aligns the faces of any image"},
        same={"mode": {"backbone_only": "reference", "finetune": "full"}},
        without={"mode": {"head_only": 'give mode="full" to train the head'}},
        # It is measured where fit is given val_dataset.
        instead={"val_after": "0"},
        folder="",
        demos="inference, eval",
        differs=(
            "`infer` returns a box for each face, with the person as `class_name`; `download` has no test data",
            "`eval` measures the recognition of enrolled persons, not of pairs",
            "one backbone, MobileFaceNet",
        ),
    ),
}
