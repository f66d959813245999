#!/bin/sh
# Trains lightweight_open_pose/openpose_default: sh models/training/openpose_default.sh [OUTPUT]
# Run it again after Ctrl-C or a power cut, and it goes on. Needs an opendr with the feature training.
#
# Pictures: coco128's train2017 under OPENDR_TEST_DATA (64 COCO pictures), labelled by MoveNet MultiPose. The backbone is
# PoseNet's, frozen: 1.2 of the 1.5 million weights. PICTURES may name another folder.
set -eu
output=${1:-runs/openpose_default}
pictures=${PICTURES:-${OPENDR_TEST_DATA:-../shared}/data/coco128/images/train2017}
zoo=$output/zoo
opendr download posenet/mnv1_385 --to "$zoo"
resume=
[ -d "$output/checkpoints" ] && resume=--resume
opendr fit lightweight_open_pose "$pictures" --output "$output" $resume \
    --teacher movenet/multipose --teacher-threshold 0.2 \
    --backbone "$zoo/posenet/mnv1_385" --freeze true --width 0.75 --extra-blocks 2 \
    --channels 96 --separable true --num-refinement-stages 1 \
    --crop-size 256 --batch-size 8 --epochs 500 \
    --lr 0.002 --lr-schedule cosine --warmup-steps 100 --grad-clip 100 --weight-decay 0 --ema 0.998 \
    --checkpoint-after-iter 200 --log-after 10 --seed 1
