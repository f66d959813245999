"""Persons are tracked in frames with given indices."""

import os

from opendr.engine.data import Image
from opendr.perception.object_tracking_2d import ObjectTracking2DFairMotLearner
from opendr.perception.object_tracking_2d.fair_mot import object_tracking_2d_fair_mot_learner as module

assert module.ObjectTracking2DFairMotLearner is ObjectTracking2DFairMotLearner
ObjectTracking2DFairMotLearner.download("crowdhuman_dla34", "./temp")
learner = ObjectTracking2DFairMotLearner(device="cpu", iters=1, num_epochs=1, batch_size=1, temp_path="./temp")
learner.load("./temp/crowdhuman_dla34", verbose=True)
img = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/bus.jpg"))
for frame in (7, 8, 9):
    tracks = learner.infer(img, [frame])
assert len(tracks) >= 2 and {track.frame for track in tracks} == {9}
assert len({track.id for track in tracks}) == len(tracks) and tracks.mot().shape == (len(tracks), 7)
several = learner.infer([img, img], [10, 11])
assert [tracks[0].frame for tracks in several] == [10, 11]
learner.reset()
