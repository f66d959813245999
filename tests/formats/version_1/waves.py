import pathlib, random
r = random.Random(5)
d = pathlib.Path("waves"); d.mkdir(exist_ok=True)
for part in ("TRAIN", "TEST"):
    rows = []
    for i in range(12):
        c = i % 2
        rows.append("\t".join([str(c + 1)] + [f"{(1 if (t % (4 + 4 * c)) < 2 + 2 * c else -1) + r.gauss(0, .1):.2f}" for t in range(24)]))
    if part == "TEST": rows[7] = "1\tbroken"
    (d / f"waves_{part}.tsv").write_text("\n".join(rows) + "\n")
