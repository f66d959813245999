"""OpenDR's perception.speech_recognition."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "edgespeechnets.edgespeechnets_learner": {"EdgeSpeechNetsLearner": HERE},
    "matchboxnet.matchboxnet_learner": {"MatchboxNetLearner": HERE},
    "quadraticselfonn.quadraticselfonn_learner": {"QuadraticSelfOnnLearner": HERE},
}

_INIT = "lr iters batch_size optimizer checkpoint_after_iter checkpoint_load_iter temp_path device"
_ENDS = "output_classes_n momentum preprocess_to_mfcc sample_rate"
_DIFFERS = ("trained on twelve classes of Speech Commands", "`reset` clears the audio buffer, not the weights")

LEARNERS = {
    "MatchboxNetLearner": Learner(
        init=f"{_INIT} number_of_blocks number_of_subblocks number_of_channels {_ENDS}",
        infer="batch>audio",
        methods={"download_pretrained": ""},
        mixin="opendr._upstream.learners.audio:Words",
        folder="MatchboxNet",
        demos="–",
        differs=_DIFFERS,
    ),
    "EdgeSpeechNetsLearner": Learner(
        init=f"{_INIT} architecture {_ENDS}",
        infer="batch>audio",
        demos="–",
        differs=_DIFFERS,
    ),
    "QuadraticSelfOnnLearner": Learner(
        init=f"{_INIT} expansion_order {_ENDS}",
        infer="batch>audio",
        methods={"download_pretrained": ""},
        mixin="opendr._upstream.learners.audio:Words",
        folder="QuadraticSelfOnn",
        demos="–",
        differs=_DIFFERS,
    ),
}
