#!/bin/sh
# Trains lightweight_open_pose/openpose_default: sh models/training/openpose_default.sh [OUTPUT]
# Run it again after Ctrl-C or a power cut, and it goes on. Needs an opendr with the feature training.
#
# Pictures: those of models/training/pictures.py in PICTURES (runs/pictures), and of OPENDR_TEST_DATA coco128's train2017,
# face_verification, and mmpose_samples' jhmdb and wflw; all labelled by MoveNet MultiPose. What is measured, the persons of
# mmpose_samples/coco, coco128's val2017, bus.jpg and zidane.jpg, is never trained on. The backbone is PoseNet's, frozen: 1.2
# of the 1.5 million weights.
set -eu
output=${1:-runs/openpose_default}
data=${OPENDR_TEST_DATA:-../shared}/data
all=$output-pictures
if [ ! -d "$all" ]; then
    mkdir -p "$all.part"
    for from in "${PICTURES:-runs/pictures}" "$data/coco128/images/train2017" "$data/face_verification" \
        "$data"/mmpose_samples/jhmdb/* "$data/mmpose_samples/wflw"; do
        find "$from" -maxdepth 1 -name '*.[jp][pn]g' | while read -r file; do
            cp "$file" "$all.part/$(basename "$from")-$(basename "$file")"
        done
    done
    cp "$data/photos/t1.jpg" "$data/photos/astronaut.png" "$all.part"
    mv "$all.part" "$all"
fi
zoo=$output-zoo
opendr download posenet/mnv1_385 --to "$zoo"
resume=
[ -d "$output/checkpoints" ] && resume=--resume
opendr fit lightweight_open_pose "$all" --out "$output" $resume \
    --teacher movenet/multipose --teacher-threshold 0.2 \
    --backbone "$zoo/posenet/mnv1_385" --freeze true --width 0.75 --extra-blocks 2 \
    --channels 96 --separable true --num-refinement-stages 1 \
    --crop-size 256 --batch-size 16 --epochs 60 \
    --lr 0.002 --lr-schedule cosine --warmup-steps 100 --grad-clip 100 --weight-decay 0 --ema 0.995 \
    --checkpoint-after-iter 200 --log-after 10 --seed 1
opendr optimize "$output/model" --fp16 --out "$output/fp16"
