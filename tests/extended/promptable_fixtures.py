"""Writes the fixtures of promptable segmentation: small Segment Anything networks with random weights, exported by the packages themselves,
and masks of the packages' own predictors and post-processing on one image.

    python tests/extended/promptable_fixtures.py crates/perception [PACKAGE...]

It needs torch, transformers and segment-anything (PyPI), and for edge_sam EdgeSAM's repository (folder edge_sam on PYTHONPATH) with loralib, timm
and yacs; it downloads nothing. The packages' code is run, not copied; no weights of theirs are involved.
"""

import hashlib
import json
import os
import sys
import tempfile
import types
import zipfile
from functools import partial
from pathlib import Path

import torch
from exported_network_fixtures import image, imported, runs

WIDTH, HEIGHT = 90, 60
SIDE = 128
EMBEDDING = 16
# The image is scaled by this to the longest side of the input.
SCALE = SIDE / WIDTH
POINTS = [[[31.0, 22.5]], [[70.0, 12.0], [20.0, 50.0]]]
LABELS = [[1], [1, 0]]
BOXES = [[12.0, 8.0, 61.5, 47.0], [40.0, 20.0, 88.0, 59.0]]


def randomise(model, seed):
    """Weights of one magnitude per layer, so that masks and scores differ; norms and biases stay."""
    generator = torch.Generator().manual_seed(seed)
    for name, parameter in model.named_parameters():
        if parameter.dim() > 1:
            fan_in = max(parameter[0].numel(), 1)
            signs = torch.rand(parameter.shape, generator=generator).sub(0.5).sign()
            size = 0.3 if "embed" in name or "token" in name else fan_in**-0.5
            parameter.data = signs * size
    return model.requires_grad_(False).eval()


def small_sam(modeling, **decoder):
    """A Sam of the modules of a package that has SAM's original code."""
    return modeling.Sam(
        image_encoder=modeling.ImageEncoderViT(
            depth=2, embed_dim=16, img_size=SIDE, mlp_ratio=2, norm_layer=partial(torch.nn.LayerNorm, eps=1e-6), num_heads=2,
            patch_size=16, qkv_bias=True, use_rel_pos=True, global_attn_indexes=[1], window_size=3, out_chans=EMBEDDING,
        ),
        prompt_encoder=modeling.PromptEncoder(
            embed_dim=EMBEDDING, image_embedding_size=(SIDE // 16,) * 2, input_image_size=(SIDE, SIDE), mask_in_chans=4
        ),
        mask_decoder=modeling.MaskDecoder(
            num_multimask_outputs=3,
            transformer=modeling.TwoWayTransformer(depth=2, embedding_dim=EMBEDDING, mlp_dim=16, num_heads=2),
            transformer_dim=EMBEDDING, iou_head_depth=2, iou_head_hidden_dim=16, **decoder,
        ),
    )  # fmt: skip


def calibrate(head):
    """Moves predicted IoUs, which are random, to the range of IoUs."""
    last = list(head.parameters())[-2:]
    last[0].data *= 0.1
    last[1].data += 0.6


def pixels():
    """The image at the size of the input, in floats, so that it is not rounded to whole levels."""
    levels = torch.from_numpy(image(WIDTH, HEIGHT).transpose(2, 0, 1).copy()).float()[None]
    size = (round(HEIGHT * SCALE), SIDE)
    return torch.nn.functional.interpolate(levels, size, mode="bilinear", align_corners=False)


def write(root, name, files, prompts):
    """Writes a container of the files by name, and for each prompt its mask and predicted IoU."""
    folder = imported(root, "segmentation")
    path = folder / f"{name}.zip"
    files = {key: Path(file).read_bytes() for key, file in files.items()}
    entries = [
        {"name": key, "size": len(data), "sha256": hashlib.sha256(data).hexdigest()} for key, data in files.items()
    ]
    manifest = {
        "format_version": 1, "learner": "promptable_segmenter", "task": "instance_segmentation", "params": {}, "classes": [],
        "files": entries,
    }  # fmt: skip
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for key, data in {"model.json": json.dumps(manifest).encode(), **files}.items():
            archive.writestr(zipfile.ZipInfo(key), data, compress_type=zipfile.ZIP_DEFLATED, compresslevel=9)
    expected = {"image": [WIDTH, HEIGHT], "prompts": prompts}
    (folder / f"{name}.json").write_text(json.dumps(expected) + "\n")
    areas = [sum(prompt["mask"][1::2]) for prompt in prompts]
    print(f"{path.name}: {path.stat().st_size} bytes; areas {areas} of {WIDTH * HEIGHT}; IoUs {[prompt['iou'] for prompt in prompts]}")


def prompt(mask, iou, points=None, labels=None, box=None):
    if points is None:
        given = {"box": box}
    else:
        given = {"points": ";".join(f"{x:g},{y:g},{label}" for (x, y), label in zip(points, labels))}
    return {**given, "mask": runs(mask), "iou": round(float(iou), 5)}


def export_decoder(model, name, inputs, outputs, axes):
    torch.onnx.export(
        model, tuple(inputs.values()), name, input_names=list(inputs), output_names=outputs, dynamic_axes=axes, opset_version=17, dynamo=False
    )


def original_prompts(predictor, best_of_several):
    """Masks of a SamPredictor: the best of several for one point, the only one for several points and for a box."""
    import numpy as np

    prompts = []
    for points, labels in zip(POINTS, LABELS):
        several = len(points) == 1
        masks, scores, _ = predictor.predict(
            point_coords=np.array(points), point_labels=np.array(labels), **best_of_several(several)
        )
        best = int(scores.argmax())
        prompts.append(prompt(masks[best], scores[best], points=points, labels=labels))
    for box in BOXES:
        masks, scores, _ = predictor.predict(box=np.array(box), **best_of_several(False))
        prompts.append(prompt(masks[0], scores[0], box=box))
    return prompts


def segment_anything(root):
    """The decoder as scripts/export_onnx_model.py exports it, with all masks and with the one that it selects."""
    import segment_anything.modeling as modeling
    from segment_anything import SamPredictor
    from segment_anything.utils.onnx import SamOnnxModel

    sam = randomise(small_sam(modeling), 3)
    calibrate(sam.mask_decoder.iou_prediction_head)
    cells = SIDE // 16
    torch.onnx.export(
        sam.image_encoder, (torch.zeros(1, 3, SIDE, SIDE),), "encoder.onnx", input_names=["x"], output_names=["image_embeddings"],
        opset_version=17, dynamo=False,
    )  # fmt: skip
    inputs = {
        "image_embeddings": torch.zeros(1, EMBEDDING, cells, cells),
        "point_coords": torch.zeros(1, 5, 2),
        "point_labels": torch.zeros(1, 5),
        "mask_input": torch.zeros(1, 1, 4 * cells, 4 * cells),
        "has_mask_input": torch.ones(1),
        "orig_im_size": torch.tensor([HEIGHT, WIDTH], dtype=torch.float),
    }
    axes = {"point_coords": {1: "num_points"}, "point_labels": {1: "num_points"}}
    predictor = SamPredictor(sam)
    predictor.set_torch_image(pixels(), (HEIGHT, WIDTH))
    prompts = original_prompts(predictor, lambda several: {"multimask_output": several})
    for name, single in [("segment_anything", False), ("segment_anything_single", True)]:
        export_decoder(SamOnnxModel(sam, return_single_mask=single), "decoder.onnx", inputs, ["masks", "iou_predictions", "low_res_masks"], axes)
        # The exported network selects among several masks for a box alone, whose points are two; the predictor does not.
        kept = [one for one in prompts if not single or "points" in one]
        write(root, name, {"model.onnx": "encoder.onnx", "decoder.onnx": "decoder.onnx"}, kept)


def edge_sam(root):
    """Encoder and decoder as scripts/export_onnx_model.py of EdgeSAM exports them."""
    # Heads of detectors, which the training needs.
    for name, names in {
        "mmdet.models.dense_heads": ["RPNHead", "CenterNetUpdateHead"],
        "mmdet.models.necks": ["FPN"],
        "projects.EfficientDet": ["efficientdet"],
        "mmengine": ["ConfigDict"],
    }.items():
        parts = name.split(".")
        for end in range(1, len(parts) + 1):
            sys.modules.setdefault(".".join(parts[:end]), types.ModuleType(".".join(parts[:end])))
        for attribute in names:
            setattr(sys.modules[name], attribute, None)
    import edge_sam.modeling as modeling
    from edge_sam import SamPredictor
    from edge_sam.utils.coreml import SamCoreMLModel

    sam = randomise(small_sam(modeling), 8)
    calibrate(sam.mask_decoder.iou_prediction_head)
    cells = SIDE // 16
    torch.onnx.export(
        sam.image_encoder, (torch.zeros(1, 3, SIDE, SIDE),), "encoder.onnx", input_names=["image"], output_names=["image_embeddings"],
        opset_version=17, dynamo=False,
    )  # fmt: skip
    inputs = {
        "image_embeddings": torch.zeros(1, EMBEDDING, cells, cells),
        "point_coords": torch.zeros(1, 5, 2),
        "point_labels": torch.zeros(1, 5),
    }
    axes = {"point_coords": {1: "num_points"}, "point_labels": {1: "num_points"}}
    export_decoder(SamCoreMLModel(sam), "decoder.onnx", inputs, ["scores", "masks"], axes)
    predictor = SamPredictor(sam)
    predictor.set_torch_image(pixels(), (HEIGHT, WIDTH))
    prompts = original_prompts(predictor, lambda several: {"num_multimask_outputs": 3 if several else 1})
    write(root, "edge_sam", {"model.onnx": "encoder.onnx", "decoder.onnx": "decoder.onnx"}, prompts)


def transformers(root):
    """SamModel in two networks, with inputs and outputs of Optimum's export."""
    from transformers import SamConfig, SamImageProcessor, SamMaskDecoderConfig, SamModel, SamProcessor, SamPromptEncoderConfig, SamVisionConfig

    vision = SamVisionConfig(
        hidden_size=16, output_channels=EMBEDDING, num_hidden_layers=2, num_attention_heads=2, image_size=SIDE, mlp_dim=32, mlp_ratio=2.0,
        window_size=3, global_attn_indexes=[1], num_pos_feats=EMBEDDING // 2,
    )  # fmt: skip
    prompts = SamPromptEncoderConfig(hidden_size=EMBEDDING, image_size=SIDE, mask_input_channels=4)
    decoder = SamMaskDecoderConfig(
        hidden_size=EMBEDDING, mlp_dim=16, num_attention_heads=2, iou_head_depth=2, iou_head_hidden_dim=16
    )
    config = SamConfig(vision_config=vision, prompt_encoder_config=prompts, mask_decoder_config=decoder, attn_implementation="eager")
    model = randomise(SamModel(config), 12)
    calibrate(model.mask_decoder.iou_prediction_head)
    processor = SamProcessor(
        SamImageProcessor(size={"longest_edge": SIDE}, pad_size={"height": SIDE, "width": SIDE})
    )

    class Encoder(torch.nn.Module):
        def __init__(self):
            super().__init__()
            self.vision_encoder, self.positions = model.vision_encoder, model.get_image_wide_positional_embeddings

        def forward(self, pixel_values):
            return self.vision_encoder(pixel_values)[0], self.positions().repeat(pixel_values.shape[0], 1, 1, 1)

    class Decoder(torch.nn.Module):
        def __init__(self):
            super().__init__()
            self.model = model

        def forward(self, image_positional_embeddings, image_embeddings, input_points, input_labels):
            sparse, dense = self.model.prompt_encoder(input_points, input_labels, None, None)
            masks, scores = self.model.mask_decoder(
                image_embeddings=image_embeddings, image_positional_embeddings=image_positional_embeddings,
                sparse_prompt_embeddings=sparse, dense_prompt_embeddings=dense, multimask_output=True,
            )[:2]  # fmt: skip
            return scores, masks

    torch.onnx.export(
        Encoder(), (torch.zeros(1, 3, SIDE, SIDE),), "vision_encoder.onnx", input_names=["pixel_values"],
        output_names=["image_embeddings", "image_positional_embeddings"], dynamic_axes={"pixel_values": {0: "batch_size"}},
        opset_version=17, dynamo=False,
    )  # fmt: skip
    cells = SIDE // 16
    inputs = {
        "image_positional_embeddings": torch.zeros(1, EMBEDDING, cells, cells),
        "image_embeddings": torch.zeros(1, EMBEDDING, cells, cells),
        "input_points": torch.zeros(1, 2, 3, 2),
        "input_labels": torch.ones(1, 2, 3, dtype=torch.long),
    }
    batch, points = {0: "batch_size"}, {0: "batch_size", 1: "point_batch_size", 2: "nb_points_per_image"}
    axes = {
        "image_positional_embeddings": batch,
        "image_embeddings": batch,
        "input_points": points,
        "input_labels": points,
        "iou_scores": {0: "batch_size", 1: "point_batch_size"},
        "pred_masks": {0: "batch_size", 1: "point_batch_size"},
    }
    export_decoder(Decoder(), "prompt_encoder_mask_decoder.onnx", inputs, ["iou_scores", "pred_masks"], axes)
    levels = torch.from_numpy(image(WIDTH, HEIGHT).transpose(2, 0, 1).copy()).float()
    found = []
    for given, labels in zip(POINTS, LABELS):
        batch = processor(levels, input_points=[[given]], input_labels=[[labels]], return_tensors="pt")
        with torch.no_grad():
            outputs = model(
                pixel_values=batch["pixel_values"].float(), input_points=batch["input_points"].float(), input_labels=batch["input_labels"]
            )
        masks = processor.post_process_masks(outputs.pred_masks, batch["original_sizes"], batch["reshaped_input_sizes"])[0][0]
        scores = outputs.iou_scores[0, 0]
        best = int(scores.argmax())
        found.append(prompt(masks[best], scores[best], points=given, labels=labels))
    names = ["vision_encoder.onnx", "prompt_encoder_mask_decoder.onnx"]
    write(root, "sam_transformers", dict(zip(["model.onnx", names[1]], names)), found)


def main():
    root = Path(sys.argv[1]).resolve()
    wanted = sys.argv[2:]
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        for package in (segment_anything, edge_sam, transformers):
            if not wanted or package.__name__ in wanted:
                package(root)


if __name__ == "__main__":
    main()
