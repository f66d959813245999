"""Utilities of OpenDR: the hyperparameter tuner, the ambiguity measure, file names."""
