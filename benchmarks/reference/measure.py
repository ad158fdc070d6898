"""Time the reference workload: cardume beside other programs that do the same work, in one run."""

import math
import statistics
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from benchmarks.calibration import VEHICLE_STEPS
from benchmarks.reference import native
from benchmarks.reference.numpy_across import Missions
from benchmarks.reference.pvs import CASE as PVS, pvs_work, why_no_pvs
from benchmarks.reference.workload import kernel_work, reference_plans
from benchmarks.row import RATE, TIMES, Row
from benchmarks.timing import Effort, Progress, Sample, Work, take_turns
from benchmarks.workloads import HAS_LANES, compile_lanes, vehicle_steps
from cardume.simulation.plan import Plan
from cardume.simulation.warming import warm_up

SECONDS = 30.0
MOST_MILLISECONDS = 8.0  # one mission alone
AS_C = {"C, scalar": 4.0, "C, side by side": 1.3}  # times as fast, at least
USERS_LAWS = {
    "for_lanes": ("with a user's law for lanes", 0.9),
    "with_an_if": ("with a user's law without lanes", 0.7),
}
USERS_SECONDS = 10.0
THREADS = 2
FEW, MANY = 16, 64  # missions
ALONE, SCALAR, LANES = "cardume, one mission alone", "cardume, scalar", "cardume, lanes"
C_ALONE, C_SCALAR, C_VECTOR = "C, one mission alone", "C, scalar", "C, side by side"
NUMPY = "NumPy, 512 missions, 30 s"


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """One mission alone, and many on two threads."""
    plans = reference_plans(2 if effort.is_smoke else MANY, effort)
    warm_up(plans[0])
    if HAS_LANES:
        compile_lanes(plans[0], progress)
    works = cardume_works(plans) | (c_works(plans, progress) if native.why_not() is None else {}) | numpy_work(effort)
    if why_no_pvs() is None:
        works[PVS] = pvs_work(effort)
    samples = take_turns({name: work for name, (work, _) in works.items()}, SECONDS, effort, progress)
    for name, (_, steps) in works.items():
        yield (_alone if name in (ALONE, C_ALONE) else _many)(name, samples[name], steps)
    if reason := why_no_pvs():
        yield Row(workload="reference", case=PVS, value=math.nan, unit=RATE, remark=f"not measured: {reason}")
    yield from _ratios(samples, {name: steps for name, (_, steps) in works.items()})
    if HAS_LANES:
        yield from _users_laws(plans, effort, progress)


def cardume_works(plans: Sequence[Plan]) -> dict[str, tuple[Work, int]]:
    """The engine alone, and how many vehicle-steps it makes.

    Args:
        plans: the missions.
    """
    few = plans[:FEW]
    works = {ALONE: (kernel_work(plans[:1], 1, lanes=False), steps_of(plans[:1]))}
    works[SCALAR] = kernel_work(few, THREADS, lanes=False), steps_of(few)
    if HAS_LANES:
        works[LANES] = kernel_work(plans, THREADS, lanes=True), steps_of(plans)
    return works


def steps_of(plans: Sequence[Plan]) -> int:
    """How many vehicle-steps all missions make together."""
    return sum(map(vehicle_steps, plans))


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
        name: (Work(partial(_fly, native.Flying(program, some), threads), threads=threads), steps_of(some))
        for name, (program, some, threads) in found.items()
    }


def numpy_work(effort: Effort) -> dict[str, tuple[Work, int]]:
    """The same in NumPy, for the first half minute: every tick takes it as long.

    Args:
        effort: how hard to try.
    """
    count, seconds = (2, effort.mission_seconds()) if effort.is_smoke else (512, 30.0)
    plans = reference_plans(count, effort, [f"duration={seconds} s"])
    return {NUMPY: (Work(Missions.fly, partial(Missions, plans)), steps_of(plans))}


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
        case=f"{name}, {sample.threads} thread{'s' if sample.threads > 1 else ''}",
        value=steps / sample.best * 1e-6,
        unit=RATE,
        median=steps / sample.median * 1e-6,
        cpu=steps / sample.cpu * sample.threads * 1e-6,
        ratio=sample.ratio * VEHICLE_STEPS / steps,
    )


def _ratios(samples: Mapping[str, Sample], steps: Mapping[str, int]) -> Iterator[Row]:
    """How many times as fast cardume's lanes are as the others."""
    side_by_side = [name for name in samples if name.startswith(C_VECTOR)]
    for kind, rivals in {"C, scalar": [C_SCALAR], "C, side by side": side_by_side, "NumPy": [NUMPY]}.items():
        case = f"cardume's lanes beside {kind}"
        no_c = native.why_not() if kind != "NumPy" else None
        if reason := no_c or ("" if HAS_LANES else "there are no lanes without compilation"):
            yield Row(workload="reference", case=case, value=math.nan, unit=TIMES, remark=f"not measured: {reason}")
            continue
        best = min(rivals, key=lambda name: samples[name].cpu / steps[name])
        theirs = samples[best], steps[best]
        yield as_fast(case, (samples[LANES], steps[LANES]), theirs, AS_C.get(kind))


def _users_laws(plans: Sequence[Plan], effort: Effort, progress: Progress) -> Iterator[Row]:
    """The lanes with a user's guidance law in the place of ours, one that has lanes and one that is called for each."""
    works = {"ours": kernel_work(plans, THREADS, lanes=True)}
    for law in USERS_LAWS:
        given = f"guidance={{law: 'benchmarks.reference.users_laws:{law}', lookahead: {{uniform: [3 m, 8 m]}}}}"
        theirs = reference_plans(len(plans), effort, [given])
        works[law] = kernel_work(theirs, THREADS, lanes=True)
    samples = take_turns(works, USERS_SECONDS, effort, progress)
    steps = steps_of(plans)
    for law, (case, target) in USERS_LAWS.items():
        yield as_fast(case, (samples[law], steps), (samples["ours"], steps), target)


def as_fast(case: str, ours: tuple[Sample, int], theirs: tuple[Sample, int], target: float | None) -> Row:
    """How many times as fast one is as the other, by processor time: what else runs here matters less to that.

    Args:
        case: what is compared.
        ours: times, and how many vehicle-steps were made in them.
        theirs: the same of the other.
        target: [-] at least.
    """
    (mine, my_steps), (other, other_steps) = ours, theirs
    per = my_steps / other_steps
    pairs = [per * b.cpu / a.cpu for a, b in zip(mine.taken, other.taken, strict=True)]
    clocks = [per * b.wall / a.wall for a, b in zip(mine.taken, other.taken, strict=True)]
    threads = mine.threads / other.threads
    others = f"best runs {per * other.cpu / mine.cpu:.2f} x, by the clock {statistics.median(clocks):.2f} x"
    more = f", on {threads:.0f} times the threads" if threads > 1.0 else ""
    return Row(
        workload="reference",
        case=case,
        value=statistics.median(pairs),
        unit=TIMES,
        target=target,
        remark=f"processor time of pairs of runs, the middle one; {others}{more}",
    )
