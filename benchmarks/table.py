"""Figures as tables, and two runs side by side."""

import math
from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.table import Table

from benchmarks.row import MORE_IS_BETTER, RATE, Row, rows_of
from benchmarks.workloads import HAS_LANES

PIVOTED = "families"
COLORS = {"yes": "green", "at best": "yellow", "no": "red"}
BUSY = 1.15  # by the clock over processor time
MEANING = """\
figure: the best of several runs by the clock; median: the middle one; cpu: the best in processor time, as if nothing
else ran here and threads never waited. Met: by the clock; "at best" where only the best run reaches the target.
ratio: time in calibration loops, a fixed compiled loop timed beside each run, for as many vehicle-steps (processes: in
loops of 36,000, one mission of 600 s); in processor time, on two threads by the clock. Compare it where machines or
their load differ.
Mvs/s: million vehicle-steps per second; a vehicle-step is one plant step of one vehicle."""


def show(console: Console, rows: Sequence[Row], record: dict[str, Any]) -> None:
    """Print the figures of a run.

    Args:
        console: where to.
        rows: the figures.
        record: of the run.
    """
    plain = [row for row in rows if row.workload != PIVOTED]
    if plain:
        console.print(_figures(plain, is_smoke=record["smoke"]))
    for row in plain:
        if row.remark:
            console.print(f"  {row.case}: {row.remark}", highlight=False, markup=False)
    if pivoted := [row for row in rows if row.workload == PIVOTED]:
        console.print(_families(pivoted))
    loop = record["calibration"]
    console.print(MEANING, highlight=False, markup=False)
    console.print(
        f"calibration loop: {loop['best_ms']:.2f} ms of processor time at best, {loop['median_ms']:.2f} ms median,"
        f" by the clock {loop['waiting']:.2f} times that;"
        f" Python {record['python']} on {record['num_cpus']} processors ({record['machine']}),"
        f" commit {record['commit'] or 'unknown'}, sources {record['sources']}",
        highlight=False,
        markup=False,
    )
    if loop["waiting"] > BUSY:
        console.print("This machine was busy with other things: rely on ratios and on processor times.", style="yellow")
    if not HAS_LANES:
        console.print("NUMBA_DISABLE_JIT is set: plain Python, without lanes.", style="yellow")
    if record["smoke"]:
        console.print("A smoke run: the figures mean nothing.", style="yellow")


def _figures(rows: Sequence[Row], is_smoke: bool) -> Table:
    table = Table(title="Speed", title_justify="left")
    for heading in ("workload", "what"):
        table.add_column(heading)
    for heading in ("figure", "median", "cpu", "target", "met", "ratio"):
        table.add_column(heading, justify="right", no_wrap=True)
    last = ""
    for row in rows:
        table.add_section() if row.workload != last else None
        limit = ">=" if row.unit in MORE_IS_BETTER else "<="
        table.add_row(
            row.workload if row.workload != last else "",
            row.case,
            f"{number(row.value)} {row.unit}",
            number(row.median),
            number(row.cpu),
            f"{limit} {row.target:g} {row.unit}" if row.target is not None else "",
            "" if is_smoke else _colored(row.verdict),
            number(row.ratio),
        )
        last = row.workload
    return table


def _families(rows: Sequence[Row]) -> Table:
    """The two builds side by side, and what each addition costs."""
    table = Table(title="As families are added (the engine alone, processor time)", title_justify="left")
    table.add_column("laws")
    for heading in dict.fromkeys(row.build for row in rows):
        table.add_column(f"{heading} {RATE}", justify="right")
        table.add_column("adds ns", justify="right")
        table.add_column("ratio", justify="right")
    table.add_column("once per lane")
    before: dict[str, float] = {}
    for case in dict.fromkeys(row.case for row in rows):
        cells, remark = [], ""
        for row in (r for r in rows if r.case == case):
            cost = 1e3 / row.value  # [ns] of one vehicle-step
            cells += [number(row.value), number(cost - before.get(row.build, math.nan)), number(row.ratio)]
            before[row.build], remark = cost, row.remark
        table.add_row(case, *cells, remark.removeprefix("called once per lane: "))
    return table


def compare(console: Console, rows: Sequence[Row], record: dict[str, Any], then: dict[str, Any], name: str) -> None:
    """Print how much faster each figure is than in a run that was kept.

    Args:
        console: where to.
        rows: the figures now.
        record: of the run now.
        then: the run that was kept.
        name: what to call it.
    """
    same_loop = record["calibration"]["loop"] == then["calibration"]["loop"]
    table = Table(title=f"Against {name} (commit {then['commit'] or 'unknown'})", title_justify="left")
    table.add_column("workload")
    table.add_column("what")
    for heading in ("then", "now", "faster, by clock", "faster, by loop"):
        table.add_column(heading, justify="right")
    old = {row.key: row for row in rows_of(then)}
    for row in rows:
        if row.key in old:
            was = old[row.key]
            table.add_row(
                row.workload,
                f"{row.case} {row.build}".strip(),
                f"{number(was.value)} {was.unit}",
                f"{number(row.value)} {row.unit}",
                number(faster(was, row)),
                number(was.ratio / row.ratio) if same_loop else "",
            )
    console.print(table)
    console.print(
        'faster: "2.0" is twice as fast; by loop: in calibration loops, so that load matters less', highlight=False
    )
    if missing := [row for row in rows if row.key not in old]:
        console.print(f"not in {name}: {', '.join(f'{r.workload}: {r.case}' for r in missing)}", highlight=False)
    if not same_loop:
        console.print("Its calibration loop was another one: only times by the clock can be compared.", style="yellow")
    if then["smoke"] or record["smoke"]:
        console.print("One of the two was a smoke run: the comparison means nothing.", style="yellow")


def faster(was: Row, now: Row) -> float:
    """How many times faster a figure is now; NaN where it is no time and no rate.

    Args:
        was: the figure before.
        now: the same figure now.
    """
    if now.unit in MORE_IS_BETTER:
        return now.value / was.value
    return was.value / now.value if now.unit in ("s", "ms") else math.nan


def number(value: float) -> str:
    """Three digits that mean something, `-` for none."""
    if not math.isfinite(value):
        return "-"
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:#.3g}"


def _colored(verdict: str) -> str:
    return f"[{COLORS[verdict]}]{verdict}[/]" if verdict else ""
