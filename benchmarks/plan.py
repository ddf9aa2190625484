"""Floor plans, measured; the figures stand in docs/ and in the report: `python -m benchmarks.plan` (scores, times, a sample of failures), or one of them by name.

python -m benchmarks.plan scores --count 5          the 20 prompts on 5 seeds, against the bars
python -m benchmarks.plan times --count 200         CPU ms for 5, 8 and 12 rooms
python -m benchmarks.plan failures --count 10000    programs of the prior, and of an independent generator; 1,000 and more are kept
                                                    in benchmarks/records/failures.json
python -m benchmarks.plan knobs --count 120         every knob against its own term; tables over 100 seeds and more are kept in benchmarks/records/knobs.json
"""

import argparse
import sys

COUNTS = {"scores": 5, "times": 200, "failures": 200, "knobs": 12}


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.plan", description="Floor plans, measured.")
    parser.add_argument("what", nargs="*", choices=[*COUNTS, []], help="default: all")
    parser.add_argument("--count", type=int, help="seeds or programs")
    parser.add_argument("--start", type=int, default=0, help="failures, knobs: number of the first program or seed")
    parser.add_argument("--jobs", type=int, default=2, help="failures: processes")
    parser.add_argument("--source", choices=("prior", "trees"), action="append", help="failures: programs of these only")
    from benchmarks.planning import record

    chosen = parser.parse_args(arguments)
    record.commit()  # of the code that is loaded now, whatever becomes of the files meanwhile
    failed = 0
    for what in chosen.what or COUNTS:
        count = chosen.count or COUNTS[what]
        print(f"-- {what}", flush=True)
        failed += run(what, count, chosen)
    return min(1, failed)


def run(what: str, count: int, chosen: argparse.Namespace) -> int:
    """Run one measurement; return the number of failures."""
    from benchmarks.planning import failures, knobs, scores, times

    if what == "failures":
        return failures.main(count, chosen.start, tuple(chosen.source or failures.SOURCES), chosen.jobs)
    if what == "knobs":
        knobs.main(count, chosen.start)
    else:
        {"scores": scores, "times": times}[what].main(count)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
