//! What a run leaves behind: TensorBoard event files, CSV tables, curves, files written atomically.
