"""What every algorithm speaks: data, targets, data sets, learners."""
