"""Reads the text in an image. Input: sign.png, a photograph of a sign."""

import opendr

reader = opendr.learner("pp_ocr")
texts = reader.infer("sign.png")
for region in texts:
    print(f"{region.text!r} {region.confidence:.2f}")
texts.save("read_text.png")
