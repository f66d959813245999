"""Data, targets, data sets and learners: the types that all algorithms share."""
