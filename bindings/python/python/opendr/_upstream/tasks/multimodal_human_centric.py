"""OpenDR's perception.multimodal_human_centric."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner

_AV = "audiovisual_emotion_learner"
_GESTURES = "rgbd_hand_gesture_learner"
_CLIPS = Absent("give fit a DatasetIterator of pairs ((Audio, Video), Category)")
_HANDS = Absent('use ExternalDataset(path, "hands"), which reads HANDS')

MODULES: dict[str, dict[str, Home]] = {
    "": {"get_audiovisual_emotion_dataset": _CLIPS, "get_hand_gesture_dataset": _HANDS},
    f"{_AV}.algorithm.data": {"RavdessDataset": _CLIPS, "get_audiovisual_emotion_dataset": _CLIPS},
    f"{_AV}.avlearner": {"AudiovisualEmotionLearner": HERE},
    "intent_recognition_learner.algorithm.data.mm_pre": {
        "MIntRecDataset": Absent("there is no learner of intents yet; AudiovisualEmotionLearner takes audio and video"),
    },
    "intent_recognition_learner.intent_recognition_learner": {
        "IntentRecognitionLearner": Absent(
            "AudiovisualEmotionLearner takes audio and video, WhisperLearner transcribes speech"
        )
    },
    f"{_GESTURES}.algorithm.data": {"RgbdDataset": _HANDS, "get_hand_gesture_dataset": _HANDS},
    f"{_GESTURES}.rgbd_hand_gesture_learner": {
        "RgbdHandGestureLearner": HERE,
        "get_hand_gesture_dataset": _HANDS,
    },
}

LEARNERS = {
    "RgbdHandGestureLearner": Learner(
        init="n_class architecture pretrained lr_scheduler!scheduler optimizer weight_decay iters batch_size n_workers"
        " checkpoint_after_iter checkpoint_load_iter temp_path device test_mode",
        infer="img>image depth",
        fit="train_set>dataset val_set>val_dataset test_set!test logging_path silent verbose",
        eval="dataset silent verbose",
        instead={
            "architecture": "alexnet densenet121 densenet161 densenet169 densenet201 googlenet mnasnet0_5 mnasnet1_0"
            " mobilenet_v2 resnet18 resnet34 resnet50 resnet101 resnet152 resnext50_32x4d resnext101_32x8d vgg11"
            " vgg11_bn vgg13 vgg13_bn vgg16 vgg16_bn vgg19 vgg19_bn wide_resnet50_2 wide_resnet101_2"
        },
        folder="",
        demos="gesture_recognition",
        differs=(
            "`infer` takes image and depth as two inputs, not four channels in one; they are not normalised before",
            "one network, `small`, without a pretrained model; it can be trained",
        ),
    ),
    "AudiovisualEmotionLearner": Learner(
        init="num_class seq_length fusion mod_drop pretr_ef lr lr_steps momentum dampening weight_decay iters"
        " batch_size n_workers device",
        infer="audio video",
        fit="dataset val_dataset logging_path silent verbose eval_mode!mode restore_best!restore",
        eval="dataset silent verbose mode!mode",
        methods={"load_inference_data": "", "pred_to_label": ""},
        mixin="opendr._upstream.learners.audio:AudiovisualEmotion",
        folder="",
        demos="audiovisual_emotion_recognition",
        differs=("there is no pretrained model; it can be trained",),
    ),
}
