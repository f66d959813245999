"""Writes the fixtures of CLIP-like networks: small networks with random weights, exported as Optimum does, a tokeniser, and what transformers
and open_clip make of texts and images.

    python tests/extended/exported_clip_fixtures.py crates/perception

It needs torch, torchvision, transformers, open_clip_torch, onnx and onnxruntime, and downloads nothing. The fixtures are the containers clip.zip
(one network of transformers), clip_parts.zip (two) and open_clip.zip (one network of open_clip), each beside NAME.json, and clip_tokens.json,
in tests/imported of classification. The packages' code is run, not copied; no weights or vocabularies of theirs are involved.
"""

import hashlib
import json
import os
import sys
import tempfile
import zipfile
from collections import Counter
from pathlib import Path

import numpy as np
import torch
from exported_network_fixtures import image, imported, randomise
from transformers import CLIPConfig, CLIPImageProcessor, CLIPModel, CLIPTokenizer

SIDE = 32
LABELS = ["cat", "red traffic cone", "dog's bowl", "empty café"]
TEMPLATE = "a photo of a {}"
CORPUS = """a photo of a cat, a photo of the dog. a bad photo of the red traffic cone; the robot's camera, they're in an empty kitchen and we'll
see the table, the chair, the door, the window, the coffee cup, the café at the corner. it isn't a drawing of the person who has
opened the door: 12 persons, 345 cones, 67 % of them. photos of a small naïve übung, ein kleiner apfel, größe, 猫の写真, фото кота"""
TEXTS = [
    "",
    " ",
    "a photo of a cat",
    "A Photo of a CAT!!",
    "dog's bowl, they're we'll I'd I'm you've isn't 'sound '' 's",
    "  white \t\n space\u00a0and\u3000more ",
    "caf\u00e9 cafe\u0301 \u00dcbung GR\u00d6SSE gro\u00df \u0130stanbul \u03a3\u03a3\u03a3 na\u00efve",
    "345 12.5 % \u00bd \u2167 \u0663 x2y \u00b2",
    "...!?'s#@ --- ((( 'll) \u2019s \u201cquote\u201d don\u2019t",
    "\u732b\u306e\u5199\u771f \u0444\u043e\u0442\u043e \u043a\u043e\u0442\u0430 \u0915\u0941\u0924\u094d\u0924\u093e \u0e41\u0e21\u0e27 \u0627\u0644\u0642\u0637\u0629",
    "\U0001f431\U0001f436 \u24b6 \u00aa \u02b0 \U0001d400 e\u0301\u0323 \uac00 \u1112\u1161\u11ab \ufb01",
    "under_score a-b a/b <tag> | <|start| \\ ~",
    "\u0000control\u007f \u200bzero\u200dwidth \ufeff",
    "word " * 90,
]


def vocabulary(merges=150):
    """A vocabulary in the order of CLIP's: bytes, bytes that end a word, merges, special tokens."""
    from transformers.convert_slow_tokenizer import bytes_to_unicode

    characters = list(bytes_to_unicode().values())
    spelled = bytes_to_unicode()
    words = Counter()
    for word in CORPUS.lower().split():
        symbols = [spelled[byte] for byte in word.encode()]
        words[(*symbols[:-1], symbols[-1] + "</w>")] += 1
    pairs = []
    for _ in range(merges):
        counts = Counter()
        for word, count in words.items():
            for pair in zip(word, word[1:]):
                counts[pair] += count
        best = max(counts, key=lambda pair: (counts[pair], pair))
        pairs.append(best)
        joined = Counter()
        for word, count in words.items():
            made, at = [], 0
            while at < len(word):
                is_pair = word[at : at + 2] == best
                made.append("".join(best) if is_pair else word[at])
                at += 2 if is_pair else 1
            joined[tuple(made)] += count
        words = joined
    tokens = [*characters, *(character + "</w>" for character in characters), *("".join(pair) for pair in pairs)]
    tokens = list(dict.fromkeys(tokens)) + ["<|startoftext|>", "<|endoftext|>"]
    return {token: index for index, token in enumerate(tokens)}, pairs


def write_container(path, files, classes):
    entries = [
        {"name": name, "size": len(data), "sha256": hashlib.sha256(data).hexdigest()} for name, data in files.items()
    ]
    manifest = {
        "format_version": 1,
        "learner": "zero_shot_classifier",
        "task": "image_classification",
        "params": {},
        "classes": classes,
        "files": entries,
    }
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        archive.writestr(zipfile.ZipInfo("model.json"), json.dumps(manifest))
        for name, data in files.items():
            archive.writestr(zipfile.ZipInfo(name), data, compress_type=zipfile.ZIP_DEFLATED, compresslevel=9)
    print(f"{path.name}: {path.stat().st_size} bytes")


class Both(torch.nn.Module):
    """The arguments in the order in which Optimum exports them."""

    def __init__(self, model):
        super().__init__()
        self.model = model

    def forward(self, input_ids, pixel_values, attention_mask):
        out = self.model(input_ids=input_ids, pixel_values=pixel_values, attention_mask=attention_mask)
        return out.logits_per_image, out.logits_per_text, out.text_embeds, out.image_embeds


class Image(torch.nn.Module):
    def __init__(self, model):
        super().__init__()
        self.vision_model, self.visual_projection = model.vision_model, model.visual_projection

    def forward(self, pixel_values):
        out = self.vision_model(pixel_values=pixel_values)
        return self.visual_projection(out.pooler_output), out.last_hidden_state


class Text(torch.nn.Module):
    def __init__(self, model):
        super().__init__()
        self.text_model, self.text_projection = model.text_model, model.text_projection

    def forward(self, input_ids):
        out = self.text_model(input_ids=input_ids)
        return self.text_projection(out.pooler_output), out.last_hidden_state


# Axes of dynamic size, as of Optimum.
AXES = {
    "pixel_values": {0: "image_batch_size", 1: "num_channels", 2: "height", 3: "width"},
    "input_ids": {0: "text_batch_size", 1: "sequence_length"},
    "attention_mask": {0: "text_batch_size", 1: "sequence_length"},
    "image_embeds": {0: "image_batch_size"},
    "text_embeds": {0: "text_batch_size"},
    "logits_per_image": {0: "image_batch_size", 1: "text_batch_size"},
    "logits_per_text": {0: "text_batch_size", 1: "image_batch_size"},
}


def export(model, arguments, path, inputs, outputs):
    axes = {name: AXES[name] for name in [*inputs, *outputs] if name in AXES}
    with torch.no_grad():
        torch.onnx.export(
            model, arguments, path, input_names=inputs, output_names=outputs, dynamic_axes=axes, opset_version=17, dynamo=False
        )
    return Path(path).read_bytes()


# Margins of the crops are even: of odd ones, transformers cuts less on the left, and torchvision, which open_clip uses, the even number.
SIZES = [(32, 32), (96, 72), (47, 90), (20, 24)]


def expected(logits_of, scale):
    """The probabilities of the fixtures' images; `logits_of` maps an image to the logits of its classes."""
    images = []
    with torch.no_grad():
        for width, height in SIZES:
            [row] = logits_of(image(width, height)).softmax(1).tolist()
            images.append({"size": [width, height], "probabilities": [round(value, 6) for value in row]})
            print(width, height, images[-1]["probabilities"])
    return json.dumps({"labels": ";".join(LABELS), "logit_scale": scale, "images": images}) + "\n"


def open_clip(folder, vocab, tokens, tokenizer):
    """A network of open_clip, whose forward returns the features and the factor; it pads texts with zeros."""
    import PIL.Image
    from open_clip.model import CLIP
    from open_clip.transform import image_transform

    tokens = tokens.masked_fill(tokens == vocab["<|endoftext|>"], 0)
    tokens[torch.arange(len(LABELS)), (tokens != 0).sum(1)] = vocab["<|endoftext|>"]
    vision = {"layers": 2, "width": 32, "head_width": 16, "patch_size": 8, "image_size": SIDE, "mlp_ratio": 1.0}
    text = {"context_length": 77, "vocab_size": len(vocab), "width": 32, "heads": 2, "layers": 2, "mlp_ratio": 1.0}
    torch.manual_seed(5)
    model = CLIP(24, vision, text).eval()
    randomise(model, 5)
    model.visual.class_embedding.data.sign_()
    model.logit_scale.data.fill_(np.log(30.0))
    transform = image_transform(SIDE, is_train=False)

    def logits_of(levels):
        pixels = transform(PIL.Image.fromarray(levels))[None]
        features, texts, scale = model(pixels, tokens)
        return scale * features @ texts.T

    (folder / "open_clip.json").write_text(expected(logits_of, 30.0))
    torch.backends.mha.set_fastpath_enabled(False)
    outputs = ["image_features", "text_features", "logit_scale"]
    example = torch.zeros(1, 3, SIDE, SIDE), tokens[:1]
    onnx = export(model, example, "open_clip.onnx", ["image", "text"], outputs)
    write_container(folder / "open_clip.zip", {"model.onnx": onnx, **tokenizer}, LABELS)


def main():
    folder = imported(Path(sys.argv[1]).resolve(), "classification")
    vocab, merges = vocabulary()
    tokenizer = CLIPTokenizer(vocab=vocab, merges=merges, model_max_length=77)
    ids = [tokenizer(text, truncation=True, max_length=77)["input_ids"] for text in TEXTS]
    tokens = {"texts": TEXTS, "tokens": ids}
    (folder / "clip_tokens.json").write_text(json.dumps(tokens) + "\n")

    config = CLIPConfig(
        text_config={
            "vocab_size": len(vocab), "hidden_size": 32, "intermediate_size": 32, "num_hidden_layers": 2, "num_attention_heads": 2,
            "bos_token_id": vocab["<|startoftext|>"], "eos_token_id": vocab["<|endoftext|>"], "pad_token_id": vocab["<|endoftext|>"],
        },
        vision_config={
            "image_size": SIDE, "patch_size": 8, "hidden_size": 32, "intermediate_size": 32, "num_hidden_layers": 2, "num_attention_heads": 2,
        },
        projection_dim=24,
        attn_implementation="eager",
    )  # fmt: skip
    torch.manual_seed(3)
    model = CLIPModel(config).eval()
    randomise(model, 3)
    model.vision_model.embeddings.class_embedding.data.sign_()
    model.logit_scale.data.fill_(np.log(20.0))

    processor = CLIPImageProcessor(size={"shortest_edge": SIDE}, crop_size={"height": SIDE, "width": SIDE})
    encoded = tokenizer([TEMPLATE.format(label) for label in LABELS], padding="max_length", max_length=77, return_tensors="pt")

    def logits_of(levels):
        pixels = processor(levels, return_tensors="pt")["pixel_values"]
        return model(pixel_values=pixels, **encoded).logits_per_image

    probabilities = expected(logits_of, 20.0)
    for name in ["clip", "clip_parts"]:
        (folder / f"{name}.json").write_text(probabilities)
    pixels = torch.zeros(1, 3, SIDE, SIDE)
    example = encoded["input_ids"], pixels, encoded["attention_mask"]
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        tokenizer.save_pretrained(scratch)
        read = lambda name: Path(name).read_bytes()
        both = export(
            Both(model), example, "both.onnx", ["input_ids", "pixel_values", "attention_mask"],
            ["logits_per_image", "logits_per_text", "text_embeds", "image_embeds"],
        )  # fmt: skip
        write_container(folder / "clip.zip", {"model.onnx": both, "tokenizer.json": read("tokenizer.json")}, LABELS)
        vision = export(Image(model), (pixels,), "vision.onnx", ["pixel_values"], ["image_embeds", "last_hidden_state"])
        text = export(Text(model), example[:1], "text.onnx", ["input_ids"], ["text_embeds", "last_hidden_state"])
        lines = "\n".join(["#version: 0.2", *(" ".join(pair) for pair in merges)]) + "\n"
        words = {"vocab.json": json.dumps(vocab).encode(), "merges.txt": lines.encode()}
        write_container(folder / "clip_parts.zip", {"model.onnx": vision, "text.onnx": text, **words}, [])
        open_clip(folder, vocab, encoded["input_ids"].clone(), words)

if __name__ == "__main__":
    main()
