"""Time the reference workload: cardume beside other programs that do the same work, in one run."""

import statistics
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from benchmarks.calibration import VEHICLE_STEPS
from benchmarks.reference import native
from benchmarks.reference.workload import kernel_work, reference_plans
from benchmarks.row import RATE, TIMES, Row
from benchmarks.timing import Effort, Progress, Sample, Work, take_turns
from benchmarks.workloads import HAS_LANES, compile_lanes, vehicle_steps
from cardume.simulation.plan import Plan
from cardume.simulation.warming import warm_up

SECONDS = 30.0
MOST_MILLISECONDS = 8.0  # one mission alone
AS_C = {"scalar": 4.0, "side by side": 1.3}  # times as fast, at least
THREADS = 2
FEW, MANY = 16, 64  # missions
ALONE, SCALAR, LANES = "cardume, one mission alone", "cardume, scalar", "cardume, lanes"
C_ALONE, C_SCALAR, C_VECTOR = "C, one mission alone", "C, scalar", "C, side by side"


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """One mission alone, and many on two threads."""
    plans = reference_plans(2 if effort.is_smoke else MANY, effort)
    warm_up(plans[0])
    if HAS_LANES:
        compile_lanes(plans[0], progress)
    works = cardume_works(plans) | (c_works(plans, progress) if native.why_not() is None else {})
    samples = take_turns({name: work for name, (work, _) in works.items()}, SECONDS, effort, progress)
    steps = vehicle_steps(plans[0])
    for name, (work, count) in works.items():
        yield (_many if work.threads > 1 else _alone)(name, samples[name], count * steps)
    yield from _ratios(samples, {name: count for name, (_, count) in works.items()})


def cardume_works(plans: Sequence[Plan]) -> dict[str, tuple[Work, int]]:
    """The engine alone, and how many missions it flies.

    Args:
        plans: the missions.
    """
    few = plans[:FEW]
    works = {ALONE: (kernel_work(plans[:1], 1, lanes=False), 1)}
    works[SCALAR] = kernel_work(few, THREADS, lanes=False), len(few)
    if HAS_LANES:
        works[LANES] = kernel_work(plans, THREADS, lanes=True), len(plans)
    return works


def c_works(plans: Sequence[Plan], progress: Progress) -> dict[str, tuple[Work, int]]:
    """The same in C.

    Args:
        plans: the missions.
        progress: called with a text.
    """
    progress("compiling C", 0, 0)
    few = plans[:FEW]
    found = {C_ALONE: (native.SCALAR, plans[:1], 1), C_SCALAR: (native.SCALAR, few, THREADS)}
    found |= {
        f"{C_VECTOR}, {bits} bits": (program, plans, THREADS) for bits, program in native.vector_programs().items()
    }
    return {
        name: (Work(partial(_fly, native.Flying(program, some), threads), threads=threads), len(some))
        for name, (program, some, threads) in found.items()
    }


def _fly(flying: native.Flying, threads: int, _: None) -> None:
    flying.fly(threads)


def _alone(name: str, sample: Sample, steps: int) -> Row:
    return Row(
        workload="reference",
        case=name,
        value=sample.best * 1e3,
        unit="ms",
        target=MOST_MILLISECONDS if name == ALONE else None,
        median=sample.median * 1e3,
        cpu=sample.cpu * 1e3,
        ratio=sample.ratio * VEHICLE_STEPS / steps,
    )


def _many(name: str, sample: Sample, steps: int) -> Row:
    return Row(
        workload="reference",
        case=f"{name}, {sample.threads} threads",
        value=steps / sample.best * 1e-6,
        unit=RATE,
        median=steps / sample.median * 1e-6,
        cpu=steps / sample.cpu * sample.threads * 1e-6,
        ratio=sample.ratio * VEHICLE_STEPS / steps,
    )


def _ratios(samples: Mapping[str, Sample], counts: Mapping[str, int]) -> Iterator[Row]:
    """How many times as fast cardume's lanes are as C."""
    rivals = {"scalar": [C_SCALAR], "side by side": [name for name in samples if name.startswith(C_VECTOR)]}
    for kind, names in rivals.items():
        case = f"cardume's lanes beside C, {kind}"
        reason = native.why_not() or ("" if HAS_LANES else "there are no lanes without compilation")
        if reason:
            yield Row(workload="reference", case=case, value=float("nan"), unit=TIMES, remark=f"not measured: {reason}")
            continue
        best = min(names, key=lambda name: samples[name].cpu / counts[name])
        yield as_fast(case, (samples[LANES], counts[LANES]), (samples[best], counts[best]), AS_C[kind])


def as_fast(case: str, ours: tuple[Sample, int], theirs: tuple[Sample, int], target: float | None) -> Row:
    """How many times as fast one is as the other, by processor time: what else runs here matters less to that.

    Args:
        case: what is compared.
        ours: times, and how many missions were flown in them.
        theirs: the same of the other.
        target: [-] at least.
    """
    (mine, my_count), (other, other_count) = ours, theirs
    per = my_count / other_count
    pairs = [per * b.cpu / a.cpu for a, b in zip(mine.taken, other.taken, strict=True)]
    by_clock = statistics.median(per * b.wall / a.wall for a, b in zip(mine.taken, other.taken, strict=True))
    return Row(
        workload="reference",
        case=case,
        value=per * other.cpu / mine.cpu,
        unit=TIMES,
        target=target,
        median=statistics.median(pairs),
        remark=f"by processor time; by the clock {by_clock:.2f} x in the middle",
    )
