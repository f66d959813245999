"""An emotion from voice and face; the learner is trained on the given clips."""

import numpy as np
from opendr.engine.data import Audio, Video
from opendr.engine.datasets import DatasetIterator
from opendr.engine.target import Category
from opendr.perception.multimodal_human_centric import AudiovisualEmotionLearner


class Clips(DatasetIterator):
    classes = ["calm", "angry"]

    def __getitem__(self, idx):
        generator = np.random.default_rng(idx)
        sound = Audio(generator.uniform(-1, 1, 22050).astype(np.float32), 22050)
        return (sound, Video(generator.random((3, 4, 32, 32)).astype(np.float32))), Category(idx % 2)

    def __len__(self):
        return 2


learner = AudiovisualEmotionLearner(2, 4, "ia", "zerodrop", None, 0.04, [40, 55], iters=1, batch_size=2, device="cpu")
assert learner.lr_steps == [40, 55] and learner.num_class == 2
stats = learner.fit(Clips(), None, "", True, False)
assert stats["loss"]
(audio, video), _ = Clips()[0]
np.save("clip.npy", video.numpy())
with open("voice.wav", "wb") as file:
    samples = (32767 * audio.numpy().reshape(-1)).astype("<i2").tobytes()
    file.write(b"RIFF" + (36 + len(samples)).to_bytes(4, "little") + b"WAVEfmt " + (16).to_bytes(4, "little"))
    file.write(
        b"\x01\x00\x01\x00" + (22050).to_bytes(4, "little") + (44100).to_bytes(4, "little") + b"\x02\x00\x10\x00"
    )
    file.write(b"data" + len(samples).to_bytes(4, "little") + samples)
audio, video = learner.load_inference_data("voice.wav", "clip.npy")
prediction = learner.infer(audio, video)
assert learner.pred_to_label(prediction) in Clips.classes
