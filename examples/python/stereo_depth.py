"""Computes the depth of a stereo pair, in metres. Inputs: left.png and right.png, rectified images of two cameras."""

import numpy as np

import opendr

# Focal length in pixels, and the distance of the cameras in metres.
matcher = opendr.learner("semi_global_matching", focal_length=994.978, baseline=0.193001)
disparity, depth, obstacles = matcher.infer("left.png", "right.png")
metres = depth.data[np.isfinite(depth.data) & (depth.data > 0)]
print(f"{100 * metres.size / depth.data.size:.0f} % of the pixels have a depth, {metres.min():.2f} to {metres.max():.2f} m")
disparity.plot("left.png").save("stereo_depth.png")
