#!/bin/sh
# Trains single_shot_detector/ssd_default_person: sh models/training/ssd_default_person.sh [OUTPUT]
# Run it again after Ctrl-C or a power cut, and it goes on. Needs an opendr with the feature training, and cargo.
#
# Pictures: coco128's train2017 with their boxes; those of models/training/pictures.py in PICTURES (runs/pictures) and the
# photos of OPENDR_TEST_DATA that crates/perception/detection/examples/train_ssd_person.rs lists, labelled by CenterNet. What is
# measured, coco128's val2017, bus.jpg and zidane.jpg, is never trained on. The backbone is PoseNet's, frozen.
set -eu
output=${1:-runs/ssd_default_person}
zoo=$output-zoo
opendr download posenet/mnv1_385 --to "$zoo"
opendr download centernet/coco_512 --to "$zoo"
cargo run --release -p opendr-detection --features training --example train_ssd_person -- \
    "${OPENDR_TEST_DATA:-../shared}/data" "$zoo/posenet/mnv1_385" "$zoo/centernet/coco_512" "$output" \
    "${PICTURES:-runs/pictures}" freeze=14 epochs=50 lr=0.002 ema=0.99 batch_size=16 val_after=10
opendr optimize "$output/model" --fp16 --out "$output/fp16"
