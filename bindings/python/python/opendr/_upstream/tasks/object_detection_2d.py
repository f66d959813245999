"""OpenDR's perception.object_detection_2d."""

from __future__ import annotations

from opendr._upstream.rows import HERE, Absent, Home, Learner, Runs

_NMS = "opendr._upstream.suppression"
_DATASETS = "opendr._upstream.detection_datasets"
_TRANSFORMS = "opendr._upstream.detection_transforms"
_DRAWING = "opendr._upstream.drawing"
_DETECTOR = Runs("opendr.perception.object_detection_2d:ImportedDetectorLearner")

MODULES: dict[str, dict[str, Home]] = {
    "": {"draw_bounding_boxes": _DRAWING},
    "centernet.centernet_learner": {"CenterNetDetectorLearner": HERE},
    "datasets": {
        "ConcatDataset": _DATASETS,
        "DetectionDataset": _DATASETS,
        "WiderFaceDataset": _DATASETS,
        "WiderPersonDataset": _DATASETS,
        "XMLBasedDataset": _DATASETS,
    },
    "datasets.detection_dataset": {
        "ConcatDataset": _DATASETS,
        "DetectionDataset": _DATASETS,
        "MappedDetectionDataset": _DATASETS,
    },
    "datasets.transforms": {
        "BoundingBoxListToNumpyArray": _TRANSFORMS,
        "ImageToNDArrayTransform": Absent("there is no MXNet; use ImageToNumpyArrayTransform"),
        "ImageToNumpyArrayTransform": _TRANSFORMS,
        "ResizeImageAndBoxesTransform": _TRANSFORMS,
    },
    "datasets.wider_face": {"WiderFaceDataset": _DATASETS},
    "datasets.wider_person": {"WiderPersonDataset": _DATASETS},
    "datasets.xmldataset": {"XMLBasedDataset": _DATASETS},
    "detectron2.detectron2_learner": {
        "Detectron2Learner": Absent("use ImportedDetectorLearner with an ONNX export of your model, or CenterNetDetectorLearner")
    },
    "detr.detr_learner": {"DetrLearner": _DETECTOR},
    "gem.algorithm.util.draw": {"draw": _DRAWING},
    "gem.gem_learner": {"GemLearner": HERE},
    "nanodet.nanodet_learner": {"NanodetLearner": HERE},
    "nms.cluster_nms.cluster_nms": {"ClusterNMS": _NMS},
    "nms.fast_nms.fast_nms": {"FastNMS": _NMS},
    "nms.fseq2_nms.fseq2_nms_learner": {
        "FSeq2NMSLearner": Absent("use Seq2SeqNMSLearner, which uses image edges instead of the detector's feature maps")
    },
    "nms.seq2seq_nms.seq2seq_nms_learner": {"Seq2SeqNMSLearner": HERE},
    "nms.soft_nms.soft_nms": {"SoftNMS": _NMS},
    "nms.utils": {"NMSCustom": _NMS},
    "nms.utils.nms_custom": {"NMSCustom": _NMS},
    "nms.utils.nms_dataset": {
        "Dataset_NMS": Absent("give fit of Seq2SeqNMSLearner an ExternalDataset, and `detector` for the boxes")
    },
    "retinaface.retinaface_learner": {
        "RetinaFaceLearner": Absent("use YunetLearner of face_detection, its variant `masked` for faces in masks")
    },
    "ssd.ssd_learner": {"SingleShotDetectorLearner": HERE},
    "utils.class_filter_wrapper": {"FilteredLearnerWrapper": "opendr._upstream.filtering"},
    "utils.vis_utils": {"draw_bounding_boxes": _DRAWING, "draw_detections": _DRAWING},
    "yolov3.yolov3_learner": {"YOLOv3DetectorLearner": _DETECTOR},
    "yolov5.yolov5_learner": {"YOLOv5DetectorLearner": _DETECTOR},
}

_SUBSET = "dataset use_subset subset_size verbose"
_OWN_NETWORK = "opendr._upstream.learners.own_networks:OwnNetwork"
_NOT_OF_OWN = {
    "download": "export your network to ONNX and give load the file; YoloxLearner and NanodetLearner have weights",
    "fit": "train your network in its own tool; YoloxLearner and NanodetLearner train here",
}

LEARNERS = {
    "SingleShotDetectorLearner": Learner(
        init="lr epochs batch_size device backbone img_size lr_schedule temp_path checkpoint_after_iter"
        " checkpoint_load_iter val_after log_after num_workers weight_decay momentum",
        infer="img>image threshold keep_size custom_nms nms_thresh nms_topk post_nms extract_maps",
        eval=f"{_SUBSET} nms_thresh nms_topk post_nms",
        mixin="opendr._upstream.learners.detection:SingleShotDetector",
        instead={"backbone": "vgg16_atrous resnet50_v1 mobilenet1.0 mobilenet0.25 resnet34_v1b"},
        folder="ssd_default_person",
        picture="people.jpg",
        demos="inference, train, eval; nms: cluster, soft, seq2seq inference",
        differs=(
            "pretrained only on persons, with 281 images; the backbone is `mobilenet0.75`",
            "`extract_maps=True` returns boxes without maps",
            "`optimize` writes a quantised or FP16 model",
        ),
    ),
    "CenterNetDetectorLearner": Learner(
        init="lr epochs batch_size device backbone img_size lr_schedule temp_path checkpoint_after_iter"
        " checkpoint_load_iter val_after log_after num_workers weight_decay momentum scale wh_weight center_reg_weight"
        " lr_decay_epoch lr_decay warmup_epochs flip_validation",
        infer="img>image threshold keep_size",
        eval=_SUBSET,
        folder="centernet_default",
        picture="bicycles.jpg",
        demos="inference, train, eval",
        differs=("it cannot be trained; SingleShotDetectorLearner and NanodetLearner can",),
    ),
    "NanodetLearner": Learner(
        init="model_to_use iters lr batch_size checkpoint_after_iter checkpoint_load_iter temp_path device weight_decay"
        " warmup_steps warmup_ratio lr_schedule_T_max lr_schedule_eta_min grad_clip",
        infer="input>image conf_threshold iou_threshold nms_max_num hf dynamic ch_l",
        fit="dataset val_dataset logging_path verbose logging!log seed local_rank!rank",
        eval="dataset verbose logging!log local_rank!rank",
        optimize="export_path>out verbose optimization!onnx conf_threshold!live iou_threshold!live nms_max_num!live"
        " hf!half dynamic!size ch_l!layout lazy_load!onnx",
        methods={"optimize_c_model": "C loads the container that save() writes"},
        folder="nanodet_{model_to_use=m}",
        picture="000000000036.jpg",
        demos="inference, train, eval",
        differs=(
            "one network, NanoDet-m at 416 pixels, whatever `model_to_use`",
            '`optimize` quantises the model (`calibration=`) or converts it to FP16 (`precision="fp16"`); there is no TorchScript',
            "boxes are in descending order of confidence",
        ),
    ),
    "YOLOv3DetectorLearner": Learner(
        init="lr epochs!training batch_size device backbone img_size>size lr_schedule temp_path checkpoint_after_iter"
        " checkpoint_load_iter val_after!training log_after!training num_workers!training weight_decay!training"
        " momentum!training mixup!training no_mixup_epochs!training label_smoothing!training random_shape!training"
        " warmup_epochs!training lr_decay_period!training lr_decay_epoch!training lr_decay!training",
        infer="img>image threshold keep_size!size",
        eval=_SUBSET,
        mixin=_OWN_NETWORK,
        defaults={"threshold": 0.1},
        methods=_NOT_OF_OWN,
        demos="–",
        differs=("it runs your network, `load(\"yolov3.onnx\")`; there are no weights, and it cannot be trained",),
    ),
    "YOLOv5DetectorLearner": Learner(
        init="model_name!file path device temp_path force_reload!file",
        infer="img>image size!size",
        mixin=_OWN_NETWORK,
        methods=_NOT_OF_OWN,
        demos="–",
        differs=("`path` is your network, exported to ONNX; no weights are downloaded by `model_name`",),
    ),
    "DetrLearner": Learner(
        init="model_config_path!file iters lr batch_size optimizer backbone checkpoint_after_iter checkpoint_load_iter"
        " temp_path device threshold num_classes!file panoptic_segmentation!file",
        infer="image",
        eval="dataset images_folder>split annotations_folder!part annotations_file!part verbose",
        optimize="do_constant_folding!onnx",
        mixin=_OWN_NETWORK,
        defaults={"threshold": 0.7},
        methods=_NOT_OF_OWN,
        demos="–",
        differs=("it runs your network, `load(\"detr.onnx\")`; there are no weights, and it cannot be trained",),
    ),
    "GemLearner": Learner(
        init="model_config_path dataset_config_path iters lr batch_size optimizer backbone checkpoint_after_iter"
        " checkpoint_load_iter temp_path device threshold num_classes panoptic_segmentation",
        infer="m1_image>colour m2_image>infrared",
        fit="m1_train_edataset>dataset m2_train_edataset!pairs annotations_folder!part m1_train_annotations_file!part"
        " m2_train_annotations_file!part m1_train_images_folder>split m2_train_images_folder!pairs out_dir>out"
        " trial_dir!trial logging_path silent verbose m1_val_edataset>val_dataset m2_val_edataset!pairs"
        " m1_val_annotations_file!part m2_val_annotations_file!part m1_val_images_folder>val_split"
        " m2_val_images_folder!pairs",
        eval="m1_edataset>dataset m2_edataset!pairs m1_images_folder>split m2_images_folder!pairs"
        " annotations_folder!part m1_annotations_file!part m2_annotations_file!part verbose",
        instead={"backbone": "resnet50 mobilenetv2"},
        demos="inference",
        differs=(
            "`infer` returns boxes and one `Category`, whose `probabilities` are the weights of the two sensors",
            "one data set in the format `coco_infrared` has the images of both cameras",
            "there is no pretrained model; it can be trained",
        ),
    ),
    "Seq2SeqNMSLearner": Learner(
        init="lr epochs device temp_path checkpoint_after_iter checkpoint_load_iter log_after variant iou_filtering"
        " dropout app_feats fmod_map_type fmod_map_bin app_input_dim",
        fit="dataset logging_path logging_flush_secs!flush silent verbose nms_gt_iou max_dt_boxes!live"
        " datasets_folder!path use_ssd!detector ssd_model!detector lr_step!scheduler",
        eval="dataset split verbose max_dt_boxes threshold datasets_folder!path use_ssd!detector ssd_model!detector",
        download="path model_name verbose url",
        methods={"run_nms": ""},
        mixin="opendr._upstream.learners.detection:Seq2SeqNms",
        models="seq2seq_pets_jpd_pets_fmod seq2seq_pets_ssd_wider_person_fmod seq2seq_pets_ssd_pets_fmod"
        " seq2seq_coco_frcn_coco_fmod seq2seq_coco_ssd_coco_wider_person_fmod",
        folder="{model_name=seq2seq_pets_ssd_pets_fmod}",
        demos="inference",
        differs=(
            "`infer` takes an image and a detector's boxes; `run_nms` takes arrays",
            "one model, trained on NanoDet's boxes of persons, for every `model_name`",
        ),
    ),
}
