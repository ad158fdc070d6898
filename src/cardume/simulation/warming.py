"""Compile what a mission needs before it flies: once per installation, and then again only after an edit."""

import gc
import importlib
import json
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace

from cardume.compiler.compiled import is_kept
from cardume.laws import Law
from cardume.simulation.engine import advance
from cardume.simulation.plan import Plan
from cardume.simulation.tables import make_tables

KERNEL = 12  # how many laws the engine itself is worth, in time
BESIDE = "import sys; from cardume.simulation.warming import compile_named; compile_named(sys.argv[1])"


def warm_up(plan: Plan, progress: Callable[[int, int], None] = lambda done, total: None) -> None:
    """Bring the engine and every law of a plan to machine code, from the cache on disk where it has them.

    The first time, another process compiles our own laws into that cache while this one compiles the engine.

    Args:
        plan: the mission.
        progress: called with how many of the pieces are ready, and how many there are.

    Raises:
        LawError: a law that does not compile.
    """
    laws = list({id(c.law): c.law for v in plan.vehicles for c in v.laws.values()}.values())
    total = KERNEL + len(laws)
    beside = None if is_kept(advance) else compile_beside([law for law in laws if law.is_builtin])
    # The garbage collector finds nothing in a compiler's graph, and takes a tenth of the time to say so.
    was_on = gc.isenabled()
    gc.disable()
    try:
        progress(0, total)
        advance(make_tables(replace(plan, duration=plan.tick), with_laws=False), 0, 0)
        progress(KERNEL, total)
        if beside is not None:
            beside.wait()
        for done, law in enumerate(laws):
            progress(KERNEL + done, total)
            law.handle()
    finally:
        if beside is not None:
            beside.kill()
            beside.wait()  # else it stays a zombie for as long as this process lives
        if was_on:
            gc.enable()
    progress(total, total)


def compile_beside(laws: Sequence[Law]) -> subprocess.Popen[bytes] | None:
    """Let another process bring laws into the cache on disk, where there is a processor for it.

    Whatever it does not do is done here later.

    Args:
        laws: our own, which another process can import.
    """
    if not laws or not sys.executable or (os.cpu_count() or 1) < 2:
        return None
    names = json.dumps([[law.function.__module__, law.function.__qualname__] for law in laws])
    path = os.pathsep.join(folder for folder in sys.path if folder)
    try:
        # -P: a module that lies in the folder where the user happens to be is not to be run
        return subprocess.Popen(
            [sys.executable, "-P", "-c", BESIDE, names],
            env=os.environ | {"PYTHONPATH": path},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
    except OSError:
        return None


def compile_named(names: str) -> None:
    """Compile laws, in the process that `compile_beside` starts.

    Args:
        names: JSON list of pairs of module and function.
    """
    gc.disable()
    for module, name in json.loads(names):
        getattr(importlib.import_module(module), name).handle()
