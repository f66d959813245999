//! Smaller and faster models: INT8 with calibration, FP16.
