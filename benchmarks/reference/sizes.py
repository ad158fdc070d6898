"""Whether a vehicle-step costs the same in many missions as in few, and in large fleets as in small ones."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from benchmarks.calibration import VEHICLE_STEPS, clock
from benchmarks.reference.fleets import fleet_plans
from benchmarks.reference.workload import FILE, kernel_work
from benchmarks.row import RATE, ROOT, Row
from benchmarks.timing import Effort, Progress, Sample, Work, mean, take_turns
from benchmarks.workloads import HAS_LANES, compile_lanes, vehicle_steps
from cardume.missions.opening import open_mission
from cardume.simulation.warming import warm_up
from cardume.studies.flying import fly_seeds

FEW, MANY = 64, 4096  # missions
FLEETS = (3, 10, 30, 60)  # vehicles
SECONDS = 20.0  # for the fleets
SEPARATE = 4  # flights of the few missions
THREADS, MISSIONS = 2, 16
LOOPS = 10  # of the calibration before and after a flight of many missions
LONGEST = 60.0  # [s] for the many missions
FLAT = 15.0  # [%] dearer, at most


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """Cost per vehicle-step over missions and over vehicles."""
    yield from _fleets(effort, progress)
    yield from _missions(effort, progress)


def _fleets(effort: Effort, progress: Progress) -> Iterator[Row]:
    works: dict[str, tuple[Work, int]] = {}
    for size in FLEETS[: 2 if effort.is_smoke else None]:
        plans = fleet_plans(size, 1 if effort.is_smoke else MISSIONS, effort)
        if not works:
            warm_up(plans[0])
            if HAS_LANES:
                compile_lanes(plans[0], progress)
        steps = len(plans) * vehicle_steps(plans[0])
        works[f"{size} vehicles"] = kernel_work(plans, THREADS, HAS_LANES), steps
    samples = take_turns({name: work for name, (work, _) in works.items()}, SECONDS, effort, progress)
    yield from _rows(samples, {name: steps for name, (_, steps) in works.items()})


def _missions(effort: Effort, progress: Progress) -> Iterator[Row]:
    """As a study flies them: drawn, flown, and reduced to their metrics."""
    folders = [ROOT]
    mission = open_mission(FILE, [f"duration={effort.mission_seconds()} s"], allow_code=folders)
    samples: dict[str, Sample] = {}
    steps: dict[str, int] = {}
    ticks = round(mission.duration / mission.tick) * round(mission.tick / mission.plant_step)

    def fly(count: int, times: int) -> Sample:
        name = f"{count:,} missions by fly_seeds"
        run = partial(fly_seeds, mission, range(count), allow_code=folders, threads=THREADS, lanes=HAS_LANES)
        steps[name] = count * ticks * len(mission.vehicles)
        samples[name] = timed(run, times, name, effort, progress)
        return samples[name]

    few = 2 if effort.is_smoke else FEW
    of_few = fly(few, SEPARATE).best
    fly(2 * few if effort.is_smoke else affordable(of_few), 1)
    yield from _rows(samples, steps)


def affordable(seconds: float) -> int:
    """How many missions to fly: MANY, unless they would take too long here.

    Args:
        seconds: [s] that FEW take.
    """
    counts = (MANY >> halvings for halvings in range(3))
    return next((count for count in counts if seconds * count / FEW < LONGEST), 8 * FEW)


def timed(run: Callable[[], object], times: int, name: str, effort: Effort, progress: Progress) -> Sample:
    """Time something long, a few times.

    Args:
        run: what to do.
        times: [-] how often.
        name: readable.
        effort: with the calibration loop.
        progress: called with the name.
    """
    sample = Sample(threads=THREADS)
    for turn in range(times):
        progress(name, turn, times)
        before = effort.calibration.run(LOOPS, THREADS)
        with clock(sample.taken):
            run()
        sample.calibrations.append(mean(before, effort.calibration.run(LOOPS, THREADS)))
    return sample


def _rows(samples: Mapping[str, Sample], steps: Mapping[str, int]) -> Iterator[Row]:
    first, *_ = samples
    for name, sample in samples.items():
        yield Row(
            workload="sizes",
            case=name,
            value=steps[name] / sample.best * 1e-6,
            unit=RATE,
            median=steps[name] / sample.median * 1e-6,
            cpu=steps[name] / sample.cpu * sample.threads * 1e-6,
            ratio=sample.ratio * VEHICLE_STEPS / steps[name],
        )
    *_, last = samples
    cost = {name: sample.cpu / steps[name] for name, sample in samples.items()}
    median = {name: sample.median_cpu / steps[name] for name, sample in samples.items()}
    yield Row(
        workload="sizes",
        case=f"{last} beside {first.split()[0]}",
        value=100.0 * (cost[last] / cost[first] - 1.0),
        unit="%",
        target=FLAT,
        median=100.0 * (median[last] / median[first] - 1.0),
        remark="a vehicle-step is so much dearer, by processor time",
    )
