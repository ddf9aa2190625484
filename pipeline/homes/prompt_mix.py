"""What a dataset is ordered to hold: the list of params.yaml, or a mix of prompts, read before the first home is made."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from pipeline import params
from pipeline.errors import ContentError, RefusedError, UsageError
from pipeline.execution import Progress
from pipeline.floorplan import request
from pipeline.homes.request import Request
from pipeline.manifest import digest
from pipeline.shards import Header, Mix, read_mix

SHOWN = 5  # prompts that cannot be met which are named at the start


@dataclass(frozen=True, slots=True)
class DatasetSettings:
    """The dataset that `dvc repro` makes (section `dataset`)."""

    homes: int = 24
    prompts: str = "manifests/prompts/mix.txt"  # one prompt a line
    prompted: float = 0.5  # share of the homes that take a prompt, in turn; the others draw their program from the prior


def requests_of(settings: DatasetSettings, root: Path, seed: int) -> tuple[Request, ...]:
    """Return what each home of the dataset is asked to be. Raises ContentError for a prompt file that cannot be read."""
    if settings.homes < 1 or not 0 <= settings.prompted <= 1:
        raise ContentError("params.yaml: dataset.homes must be 1 or more, dataset.prompted within 0 and 1", "mend section dataset")
    mix = read_mix(root / settings.prompts)
    # Home i takes a prompt whenever i * share passes a whole number: evenly spread, and independent of the count.
    turns = [int((i + 1) * settings.prompted) - int(i * settings.prompted) for i in range(settings.homes)]
    return tuple(Request(i, mix.prompt(seed, sum(turns[:i])) if turn else "") for i, turn in enumerate(turns))


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
    """Read the prompts; those that ask for what cannot be are said now, not after hours, with their place in the file.

    Raises RefusedError for the first of them with `strict`, or when there are no others; with `strict` prompts of which words are not
    understood, or ask for what nobody builds, are such as well.
    """
    mix = read_mix(prompts) if prompts else Mix()
    programs, errors = {}, []
    for words in dict.fromkeys(mix.prompts):
        try:
            programs[words] = request(words, strict=strict).model_dump_json(exclude_defaults=True)
        except RefusedError as error:
            errors.append(error.placed(mix.places[mix.prompts.index(words)]))
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
