"""Detects persons with a mask of each. Input: people.jpg, a photograph with persons."""

import opendr

segmenter = opendr.learner("bodypix")
persons = segmenter.infer("people.jpg")
for person in persons:
    share = person.area / (person.width * person.height)
    print(f"a person whose mask is {100 * share:.0f} % of its box, score {person.confidence:.2f}")
persons.save("mask_persons.png")
