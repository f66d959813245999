"""OpenDR's perception.compressive_learning."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Home, Learner

MODULES: dict[str, dict[str, Home]] = {
    "multilinear_compressive_learning.multilinear_compressive_learner": {"MultilinearCompressiveLearner": HERE},
}

LEARNERS = {
    "MultilinearCompressiveLearner": Learner(
        init="input_shape compressed_shape backbone n_class pretrained_backbone init_backbone lr_scheduler!scheduler"
        " optimizer weight_decay n_init_iters iters batch_size checkpoint_after_iter checkpoint_load_iter temp_path"
        " device test_mode",
        infer="img>image",
        fit="train_set>dataset val_set>val_dataset test_set!test logging_path silent verbose",
        eval="dataset silent verbose",
        methods={
            "get_sensing_parameters": "save() writes them into the container",
            "infer_from_compressed_measurement": "infer measures and classifies in one step",
        },
        instead={
            "backbone": "cifar_allcnn cifar_vgg11 cifar_vgg13 cifar_vgg16 cifar_vgg19 cifar_resnet20 cifar_resnet32"
            " cifar_resnet44 cifar_resnet56 cifar_densenet121 imagenet_vgg11 imagenet_vgg16 imagenet_resnet18"
            " imagenet_resnet50 imagenet_densenet121"
        },
        folder="",
        demos="–",
        differs=("one backbone, `small`, trained on Fashion-MNIST",),
    ),
}
