"""What a dataset is ordered to hold: a mix of prompts, read before the first home is made."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from pipeline import params
from pipeline.errors import RefusedError, UsageError
from pipeline.execution import Progress
from pipeline.floorplan import request
from pipeline.homes.request import Request
from pipeline.homes.settings import DatasetSettings, requests_of
from pipeline.manifest import digest
from pipeline.shards import Header, Mix, read_mix

SHOWN = 5  # prompts that cannot be met which are named at the start


@dataclass(frozen=True, slots=True)
class Order:
    """A mix, and the programs that were read from its prompts (as JSON); a prompt that asks for what cannot be has none."""

    seed: int
    mix: Mix
    programs: Mapping[str, str]

    def wish(self, index: int) -> Request:
        """Return what home `index` is asked to be; without words it takes its program from the prior."""
        words = self.mix.prompt(self.seed, index)
        return Request(index, words, self.programs.get(words, ""))

    def digest(self) -> str:
        """Return what identifies the order in a dataset's header."""
        return digest([self.mix.digest(), self.programs])


def read_order(prompts: Path | None, seed: int, progress: Progress, *, strict: bool) -> Order:
    """Read the prompts; those that ask for what cannot be are said now, not after hours.

    Raises RefusedError for the first of them with `strict`, or when there are no others.
    """
    mix = read_mix(prompts) if prompts else Mix()
    programs, errors = {}, []
    for words in dict.fromkeys(mix.prompts):
        try:
            programs[words] = request(words).model_dump_json(exclude_defaults=True)
        except RefusedError as error:
            errors.append(error)
    if errors and (strict or not programs):
        raise errors[0]
    for refusal in errors[:SHOWN]:
        progress.say(f"the homes of a prompt will stay empty: {refusal}")
    if len(errors) > SHOWN:
        progress.say(f"and those of {len(errors) - SHOWN} other prompts")
    return Order(seed, mix, programs)


def orders(root: Path, seed: int, prompts: Path | None) -> Iterator[tuple[str, Callable[[int], Request]]]:
    """Yield what a dataset may have been asked for, each with its digest: `prompts`, or nothing, or the list of params.yaml."""
    order = read_order(prompts, seed, Progress(0, "homes", voice="quiet"), strict=False)
    yield order.digest(), order.wish
    if prompts is None:
        tree = params.read(root / "params.yaml")
        listed = requests_of(params.section(DatasetSettings, tree, "dataset"), root, seed)
        yield digest([request.prompt for request in listed]), listed.__getitem__


def asked_of(root: Path, header: Header, prompts: Path | None) -> Callable[[int], Request]:
    """Return what the homes of a dataset were asked to be. Raises UsageError where nothing fits."""
    for words, asked in orders(root, header.seed, prompts):
        if header.digests.get("prompts") == words:
            return asked
    raise UsageError("the dataset was asked for in other words", "give the file of its prompts with --prompts, as it was")
