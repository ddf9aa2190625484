"""What each choice of the layout model is worth: nets that differ in one thing, trained on the same rooms and judged on the same floors.

    python -m benchmarks.ablations.train FOLDER STEPS [variant ...]
    python -m benchmarks.ablations.score FOLDER

`train` needs data/ as stages `preprocess` and `encode` leave it, and wants a GPU: some 30 variants of 6,000 steps are five CPU hours. `score`
needs models/ as well, and prints a row for each file that `train` wrote.
"""
