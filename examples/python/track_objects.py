"""Tracks persons over the frames of a folder, with a detector and a tracker in sequence. Input: frames/*.jpg, of a camera."""

import opendr

pipeline = opendr.Pipeline("yolox", "sort")
seen = {}
for image, predictions in pipeline.run(opendr.Source("frames")):
    tracks = predictions["tracks"]
    for track in tracks:
        seen.setdefault((track.id, track.class_name), []).append(track.left)
    last = tracks.plot(image)
for (id, name), lefts in sorted(seen.items()):
    print(f"{name} {id}: {len(lefts)} frames, moved by {lefts[-1] - lefts[0]:.0f} pixels")
last.save("track_objects.png")
