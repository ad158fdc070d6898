"""Positions and messages through water: what a fix costs, and figure-5 with all of it switched on."""

from collections.abc import Iterator

from benchmarks.calibration import VEHICLE_STEPS
from benchmarks.row import RATE, Row
from benchmarks.timing import Effort, Progress, Sample, Work, take_turns
from benchmarks.workloads import (
    HAS_LANES,
    called_once_per_lane,
    compile_lanes,
    lanes_work,
    plan_of,
    scalar_work,
    vehicle_steps,
)
from cardume.compiler import WIDTH
from cardume.simulation.plan import Plan

SECONDS = 20.0  # for each of the two questions
LAWS = {"reset": ("position=reset",), "kalman_replay": ("position=kalman_replay",)}
GNSS = "vehicles.surface.sensors.gnss.period="
OFTEN, RARELY = 0.1, 600.0  # [s] between the fixes of the surface vehicle
ALL_ON = "acoustics/figure-5-s2c"
SWITCHED_ON = (  # what of positions, messages and faults the mission leaves out
    "acoustics.codec=compact",
    "acoustics.authentication=4",
    "position.heading_sigma=1 deg",
    "position.sway_time=0.9 s",
    "vehicles.surface.sensors.usbl.bearing_loss=0.1",
    "vehicles.surface.sensors.gnss={sigma: 0.3 m, correlated_sigma: 0.4 m}",
    "faults=[{kind: usbl_outlier, vehicle: surface, from: 0 s, probability: 0.02},"
    " {kind: modem_silent, vehicle: port, from: 200 s, lasts: 60 s},"
    " {kind: gnss_lost, vehicle: surface, from: 400 s, lasts: 60 s}]",
)


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """The cost of a fix, then throughput with everything."""
    yield _cost_of_a_fix(effort, progress)
    yield from _everything(effort, progress)


def _cost_of_a_fix(effort: Effort, progress: Progress) -> Row:
    """Processor time of a mission with fixes in every tick over one with hardly any, beyond the same of `reset`."""
    plans = {
        (law, period): plan_of(effort, (*overrides, f"{GNSS}{period} s"))
        for law, overrides in LAWS.items()
        for period in (OFTEN, RARELY)
    }
    works: dict[str, Work] = {f"{law}, {period:g} s": scalar_work(plan) for (law, period), plan in plans.items()}
    samples = take_turns(works, SECONDS, effort, progress)

    def of_all_fixes(law: str) -> float:
        return samples[f"{law}, {OFTEN:g} s"].cpu - samples[f"{law}, {RARELY:g} s"].cpu

    fixes = plans["reset", OFTEN].num_ticks
    cost, of_reset = of_all_fixes("kalman_replay") / fixes, of_all_fixes("reset") / fixes
    return Row(
        workload="through water",
        case="a fix by kalman_replay",
        value=1e6 * (cost - of_reset),
        unit="us",
        cpu=1e6 * (cost - of_reset),
        remark=f"beyond what the same reading costs with reset, {1e6 * of_reset:.2f} us; processor time",
    )


def _everything(effort: Effort, progress: Progress) -> Iterator[Row]:
    """Throughput of the engine alone with everything on, both builds."""
    plan = plan_of(effort, SWITCHED_ON, name=ALL_ON)
    works: dict[str, Work] = {"everything, scalar": scalar_work(plan)}
    if HAS_LANES:
        compile_lanes(plan, progress)
        works["everything, lanes"] = lanes_work(plan)
    samples = take_turns(works, SECONDS, effort, progress)
    for case, sample in samples.items():
        yield _throughput(case, sample, plan)


def _throughput(case: str, sample: Sample, plan: Plan) -> Row:
    is_lanes = case.endswith("lanes")
    steps = vehicle_steps(plan) * (WIDTH if is_lanes else 1)
    fallen_back = called_once_per_lane(plan) if is_lanes else []
    return Row(
        workload="through water",
        case=case,
        value=steps / sample.best * 1e-6,
        unit=RATE,
        median=steps / sample.median * 1e-6,
        cpu=steps / sample.cpu * 1e-6,
        ratio=sample.ratio * VEHICLE_STEPS / steps,
        remark=f"called once per lane: {', '.join(fallen_back)}" if fallen_back else "",
    )
