"""Compile what a mission needs before it flies: once per installation, and then again only after an edit."""

import gc
from collections.abc import Callable
from dataclasses import replace

from cardume.simulation.engine import advance
from cardume.simulation.plan import Plan
from cardume.simulation.tables import make_tables


def warm_up(plan: Plan, progress: Callable[[int, int], None] = lambda done, total: None) -> None:
    """Bring the engine and every law of a plan to machine code, from the cache on disk where it has them.

    Args:
        plan: the mission.
        progress: called with how many of the pieces are ready, and how many there are.

    Raises:
        LawError: a law that does not compile.
    """
    laws = list({id(c.law): c.law for v in plan.vehicles for c in v.laws.values()}.values())
    total = len(laws) + KERNEL
    # The garbage collector finds nothing in a compiler's graph, and takes a tenth of the time to say so.
    was_on = gc.isenabled()
    gc.disable()
    try:
        for done, law in enumerate(laws):
            progress(done, total)
            law.handle()
        progress(len(laws), total)
        advance(make_tables(replace(plan, duration=plan.tick)), 0, 0)
    finally:
        if was_on:
            gc.enable()
    progress(total, total)


KERNEL = 12  # how many laws the engine itself is worth, in time
