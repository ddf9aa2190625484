"""Train on a dataset with PyTorch, such as `python examples/torch_dataset.py data/shards`."""

import sys

import torch
from torch.utils.data import DataLoader

from sfgen.torch import HomeStream, collate


def main(folder: str) -> None:
    """Learn, very briefly, the size of an object from its category."""
    data = HomeStream(folder)
    model = torch.nn.Embedding(len(data.categories), 3)
    optimiser = torch.optim.Adam(model.parameters(), lr=0.1)
    for epoch in range(3):
        total, count = 0.0, 0
        data.set_epoch(epoch)
        for batch in DataLoader(data, batch_size=8, collate_fn=collate):
            real = batch["objects"]  # (b, n): which of the padded places hold an object
            error = (model(batch["category"]) - batch["size"])[real].square()
            optimiser.zero_grad()
            error.mean().backward()
            optimiser.step()
            total, count = total + float(error.sum()), count + error.numel()
        print(f"epoch {epoch}: mean squared error {total / max(count, 1):.3f} m2")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "data/shards")
