//! Training on Burn: the loop of every `fit`, export to ONNX, import of weights.
