"""The `sfgen` command: options, messages and exit codes. What the commands do stands in stages/.

Exit codes: 0 done; 1 wrong content, or a run that failed; 2 something wrong in the command line; 3 a request that
cannot be met; 130 interrupted. Whatever goes wrong is one line on stderr: `sfgen: <thing>; <remedy>`.
"""

import gc
import importlib
import os
import re
import sys
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

ROOT = Path(__file__).resolve().parents[1]  # the checkout that this package lies in, if it does

PROMPT_HELP = "What the home shall be, in words."
SEED_HELP = "Every random choice follows from it."

OUT_HELP = "Folder of the dataset, or an address (s3://...) to which datasets/<seed> goes shard by shard; a killed run resumes. [default: datasets/<seed>]"

app = typer.Typer(
    name="sfgen",
    help="A factory for datasets of homes that robots can use.",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

STRICT_HELP = "Refuse words that are not understood, instead of leaving them out and saying so."
Strict = Annotated[bool, typer.Option("--strict", help=STRICT_HELP)]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress on stderr.")]
Machine = Annotated[bool, typer.Option("--json", help="For machines: progress as JSON lines on stderr, what came of it as one on stdout.")]
Seed = Annotated[int, typer.Option(min=0, max=2**31 - 1, help=SEED_HELP)]


class Format(StrEnum):
    """What `sfgen export` writes."""

    mjcf = "mjcf"
    urdf = "urdf"
    glb = "glb"


@app.command()
def generate(
    prompt: Annotated[str, typer.Argument(help=PROMPT_HELP, show_default=False)] = "",
    out: Annotated[Path, typer.Option(help="New or empty folder for the home.")] = Path("home"),
    seed: Seed = 0,
    plan: Annotated[Path | None, typer.Option(help="Furnish this plan of your own: JSON, 3D-FRONT or ProcTHOR.")] = None,
    house: Annotated[str | None, typer.Option(help="With --plan FILE.jsonl: which house, a line from 0 or an id.")] = None,
    strict: Strict = False,
    quiet: Quiet = False,
    json: Machine = False,
) -> None:
    """Make one home from words, or in a plan of your own: USD, tables, plan and preview.

    \b
    Example:
      sfgen generate "a two-bedroom apartment with an open kitchen" --out home/
      sfgen generate --plan my_plan.json "a bedroom with eight pieces, two nightstands, 70 % free, nordic" --out home/
    """
    if not prompt and not plan:
        raise Complaint("the prompt is empty; give PROMPT, or --plan FILE", 2)
    how = voice(quiet=quiet, json=json)
    stage("generate").main(ROOT, prompt=prompt, out=out, seed=seed, source=plan, house=house, strict=strict, voice=how)


@app.command()
def shard(
    count: Annotated[int, typer.Option(min=1, help="Number of homes.", show_default=False)],
    out: Annotated[str | None, typer.Option(help=OUT_HELP)] = None,
    seed: Seed = 0,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes, one thread each; 1 starts none. [default: the cores that may be used]")
    ] = None,
    prompts: Annotated[Path | None, typer.Option(help="Text file, a prompt a line; or list of {prompt, weight} in YAML or JSON.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="A Dask scheduler, tcp://host:port or its file, instead of --workers.")] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="Refuse prompts of which words are not understood; stop at the first home that cannot be made.")
    ] = False,
    only: Annotated[
        int | None, typer.Option(min=0, help="Make the home of this index alone and write nothing: shows what is wrong with it.")
    ] = None,
    memory: Annotated[int, typer.Option(min=600, help="Memory of a worker in MiB; with more, more of the library stays read.")] = 700,
    preview: Annotated[
        int | None, typer.Option(min=0, max=4096, help="Side of the views from above in pixels, 0 for none. [default: shard.preview, 768]")
    ] = None,
    quiet: Quiet = False,
    json: Machine = False,
) -> int:
    """Make a dataset of many homes; started again, it goes on where it was killed.

    \b
    Example:
      sfgen shard --count 200 --out datasets/mine --seed 7
      sfgen shard --count 1000 --prompts prompts.txt --scheduler tcp://10.0.0.1:8786
    """
    if out and re.match(r"[a-z][a-z0-9+]+:/(?!/)", out):
        raise Complaint(f"{out} is an address that lacks a slash; write {out.replace(':/', '://', 1)}, or ./{out} for a folder", 2)
    options = {"seed": seed, "workers": workers, "prompts": prompts, "scheduler": scheduler, "strict": strict, "only": only}
    how = voice(quiet=quiet, json=json)
    code: int = stage("shard", begins=("homes", how)).main(ROOT, count=count, out=out, **options, memory=memory, preview=preview, voice=how)
    return code


@app.command()
def plan(
    prompt: Annotated[str, typer.Argument(help=PROMPT_HELP, show_default=False)] = "",
    seed: Seed = 0,
    json: Annotated[Path | None, typer.Option(help="Write the plan here as JSON; - is the terminal.")] = None,
    svg: Annotated[Path | None, typer.Option(help="Draw the plan here as SVG.")] = None,
    png: Annotated[Path | None, typer.Option(help="Draw the plan here as PNG.")] = None,
    source: Annotated[Path | None, typer.Option("--from", help="A plan of your own instead of words: JSON, 3D-FRONT or ProcTHOR.")] = None,
    house: Annotated[str | None, typer.Option(help="With --from FILE.jsonl: which house, a line from 0 or an id.")] = None,
    prompts: Annotated[Path | None, typer.Option(help="With --score: a prompt a line, or YAML with ground truth.")] = None,
    seeds: Annotated[int, typer.Option(min=1, max=1000, help="With --score: plans of each prompt.")] = 5,
    score: Annotated[bool, typer.Option("--score", help="Plan every prompt of --prompts and print scores and seconds.")] = False,
    strict: Strict = False,
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON Schema of plan and program.")] = False,
) -> None:
    """Turn words into a floor plan and show it; or check and show a plan of your own.

    \b
    Example:
      sfgen plan "three bedrooms, two bathrooms, a kitchen that is open to the living room" --svg plan.svg
      sfgen plan --from my_plan.json --png plan.png
      sfgen plan --prompts manifests/prompts/benchmark.yaml --seeds 5 --score
    """
    given = [name for name, there in (("PROMPT", prompt), ("--from", source), ("--prompts", prompts), ("--schema", schema)) if there]
    if len(given) != 1:
        said = f"{' and '.join(given)} are given" if given else "no prompt is given"
        raise Complaint(f"{said}; give one of PROMPT, --from FILE, --prompts FILE --score, --schema", 2)
    if bool(prompts) != score:
        raise Complaint("--prompts and --score go together; give both or neither", 2)
    module = stage("plan")
    if schema:
        module.schema(ROOT)
    elif prompts:
        module.score(ROOT, prompts=prompts, seeds=seeds, json_path=json)
    else:
        module.main(ROOT, prompt=prompt, seed=seed, source=source, house=house, json_path=json, svg_path=svg, png_path=png, strict=strict)


@app.command()
def peers(
    out: Annotated[Path, typer.Option(help="New or empty folder for the rooms.", show_default=False)],
    filtered: Annotated[bool, typer.Option("--filtered", help="Only rooms that pass the peers' own filters.")] = False,
) -> None:
    """Write the training tables as ATISS and DiffuScene cache them: boxes.npz, dataset_stats.txt, splits.

    \b
    Example:
      sfgen peers --out peers/ --filtered
    """
    stage("peers").main(ROOT, out=out, filtered=filtered)


@app.command()
def export(
    dataset: Annotated[Path, typer.Argument(metavar="DATASET", help="Folder of a dataset.", show_default=False)],
    to: Annotated[Format, typer.Option(help="MuJoCo's XML, a URDF per thing that moves, or a glTF file per home.", show_default=False)],
    out: Annotated[Path, typer.Option(help="New or empty folder; a killed export goes on.", show_default=False)],
    home: Annotated[list[str] | None, typer.Option(help="Only this home, by its scene_id; may be given again.")] = None,
) -> None:
    """Write homes in other formats than USD: the same joints, limits, masses and colliders.

    \b
    Example:
      sfgen export data/shards --to mjcf --out exported/mjcf
      sfgen export datasets/7 --to glb --home s7_00000003 --out exported/glb
    """
    stage("export").main(ROOT, dataset=dataset, to=to.value, out=out, homes=home or ())


@app.command()
def verify(
    folder: Annotated[str, typer.Argument(metavar="DATASET", help="Folder of a dataset, or its address (s3://...).", show_default=False)],
    quick: Annotated[bool, typer.Option("--quick", help="Leave out opening every stage with USD.")] = False,
    reproduce: Annotated[int, typer.Option(min=0, help="Make so many of its homes again, and say what comes out otherwise here.")] = 0,
    prompts: Annotated[Path | None, typer.Option(help="With --reproduce: the file that it was made with, if it was.")] = None,
    quiet: Quiet = False,
    json: Machine = False,
) -> int:
    """Check a dataset: every sha256, row, id, reference and stage; the first wrong thing is named. Stages need the factory, the rest does not.

    \b
    Example:
      sfgen verify data/shards
      sfgen verify data/shards --quick --reproduce 4
    """
    how, local = voice(quiet=quiet, json=json), "://" not in folder
    if local and not Path(folder).is_dir():
        raise Complaint(f"{folder} is {'not a folder' if Path(folder).exists() else 'missing'}; give the folder of a dataset", 2)
    if reproduce or (local and is_checkout()):
        code: int = stage("verify").main(ROOT, folder=Path(folder), quick=quick, reproduce=reproduce, prompts=prompts, voice=how)
        return code
    from dataclasses import asdict

    from sfgen.check import check

    begin("files", how)
    summary = check(folder)
    if how == "json":
        import json as form

        typer.echo(form.dumps({"event": "done", "dataset": folder, **asdict(summary)}))
    else:
        typer.echo(summary.line(folder) + ("" if quick else "; no stage was opened with USD: that needs a folder, and the factory"))
    return 0


@app.command()
def repair(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a dataset.", show_default=False)],
    prompts: Annotated[Path | None, typer.Option(help="The file that it was made with, if it was.")] = None,
    workers: Annotated[int | None, typer.Option(min=1, help="As for shard.")] = None,
    quiet: Quiet = False,
    json: Machine = False,
) -> int:
    """Make again what is broken or missing of a dataset, byte for byte; needs the checkout that made it.

    \b
    Example:
      sfgen repair datasets/7
    """
    how = voice(quiet=quiet, json=json)
    code: int = stage("shard", begins=("homes", how)).repair(ROOT, folder=folder, prompts=prompts, workers=workers, voice=how)
    return code


@app.command()
def doctor(
    use: Annotated[
        list[Path] | None,
        typer.Option(help="Folder of 3D-FRONT + 3D-FUTURE, or of PartNet objects, to train on from now on; may be given twice."),
    ] = None,
    json: Machine = False,
) -> None:
    """Say what is installed, what is made, what is missing, and the command that makes it; or take real copies of the data into use.

    \b
    Example:
      sfgen doctor
      sfgen doctor --use /data/3d-front --use /data/partnet-mobility
      sfgen doctor --use embedded
    """
    if use:
        stage("adopt").main(ROOT, use)
    else:
        stage("doctor").main(ROOT, voice=voice(quiet=False, json=json))


@app.callback(invoke_without_command=True)
def version(*, version: Annotated[bool, typer.Option("--version", help="Show the version and exit.")] = False) -> None:
    """Make datasets of homes that robots can use."""
    if version:
        from sfgen import __version__

        typer.echo(__version__)
        raise typer.Exit


def voice(*, quiet: bool, json: bool) -> str:
    """Return how a command speaks."""
    return "json" if json else "quiet" if quiet else "plain"


def begin(label: str, how: str) -> None:
    """Say that a long command has begun, before what it needs is loaded."""
    if how == "plain":
        sys.stderr.write(f"{label}: starting\n")
    elif how == "json":
        sys.stderr.write('{"event": "said", "text": "starting"}\n')


class Complaint(Exception):  # noqa: N818 - not an error of the program
    """Something that the command line itself has to say; `exit_code` as in the factory's errors."""

    def __init__(self, text: str, exit_code: int) -> None:
        self.exit_code = exit_code
        super().__init__(text)


def is_checkout() -> bool:
    """Tell whether this package lies in a checkout; a bare wheel does not."""
    return (ROOT / "dvc.yaml").is_file() and (ROOT / "stages").is_dir()


def stage(name: str, begins: tuple[str, str] | None = None) -> Any:
    """Import what a command does, and say before that it `begins` (label, voice). Raises Complaint from a bare wheel.

    Heavy packages come with it, of which nothing is ever garbage: collecting waits until they are there.
    """
    if not is_checkout():
        text = "this command needs the factory, and only the loaders are installed; clone sfgen's repository and type `make run` in it"
        raise Complaint(text, 1)
    if begins:
        begin(*begins)
    if str(ROOT) not in sys.path:
        sys.path.insert(0, str(ROOT))
    gc.disable()
    try:
        return importlib.import_module(f"stages.{name}")
    finally:
        gc.freeze()
        gc.enable()


def run(arguments: Sequence[str]) -> int:
    """Run one command line and return its exit code; what went wrong is said in one line on stderr."""
    try:
        code = app(args=list(arguments), prog_name="sfgen", standalone_mode=False)
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # The reader (head, less) is gone: nothing is wrong, and nobody listens.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:  # the last line of defence: users get a line, not a traceback
        if os.environ.get("SFGEN_DEBUG"):
            raise
        text, code = explain(error)
        if text:
            sys.stderr.write(f"sfgen: {text}\n")
        return code
    return code if isinstance(code, int) else 0


def explain(error: Exception) -> tuple[str, int]:
    """Return the text that explains an error, and the exit code."""
    kinds = {kind.__name__ for kind in type(error).__mro__}
    if "ClickException" in kinds or "TyperException" in kinds or "Abort" in kinds:  # typer carries a click of its own
        return explain_usage(error, kinds)
    if isinstance(code := getattr(error, "exit_code", None), int):
        return one_line(str(error)), code
    if isinstance(error, ModuleNotFoundError) and (error.name or "").split(".")[0] not in {"stages", "pipeline", "schemas", "sfgen"}:
        return f"the package {error.name} is not installed; type `make run`, or `pip install -c constraints.txt -e '.[factory,render]'`", 1
    if isinstance(error, OSError) and error.strerror:
        where = f": {error.filename}" if error.filename else ""
        return f"{error.strerror}{where}; see to the disk, or give another place", 1
    if isinstance(error, MemoryError):
        return "out of memory; give fewer --workers", 1
    return f"unexpected {type(error).__name__}: {one_line(str(error))}; SFGEN_DEBUG=1 shows where: please report it", 1


def explain_usage(error: Exception, kinds: set[str]) -> tuple[str, int]:
    """Return the text for what the command-line parser raises, and the exit code."""
    context = getattr(error, "ctx", None)
    if "Abort" in kinds:
        return "", 130
    if "NoArgsIsHelpError" in kinds and context:
        return "no command is given; choose one\n\n" + context.get_help(), 2
    text = one_line(error.format_message()).rstrip(".")  # type: ignore[attr-defined]
    return f"{text}; see `{context.command_path if context else 'sfgen'} --help`", 2


def one_line(text: str) -> str:
    """Join the lines of a message."""
    return " ".join(text.split())


def main() -> None:
    """Entry point of the console command."""
    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
