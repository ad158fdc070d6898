"""Find values of a few keys with which a mission does best over all that it draws, and prove it on fresh seeds."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from cardume.errors import InputError
from cardume.missions.available import catalog
from cardume.missions.drawing import refuse_sweeps
from cardume.missions.mission import Mission
from cardume.simulation.flight import METRICS
from cardume.studies.arms import Arm, Given, check_metrics, open_given
from cardume.studies.constants import DEFAULT_MET, DEFAULT_TRIES, DEFAULT_TUNED
from cardume.studies.flying import Progress
from cardume.studies.tuning.evidence import Evidence
from cardume.studies.tuning.knobs import Knob, make_knobs, with_values
from cardume.studies.tuning.resuming import known_tries
from cardume.studies.tuning.searching import Enough, Goal, Try, best_of, front_of, search_one, search_several
from cardume.studies.tuning.trying import Remember, Settings, Tries

FEWEST_TRIES, MOST_TRIES, MOST_RUNS, MOST_METRICS = 10, 10_000, 10_000, 3


@dataclass(frozen=True)
class Tuning:
    """What a search found.

    Attributes:
        settings: what was searched.
        recommended: the mission with the values to fly with: those found, if they are better, else its own.
        runs: of a try.
        tries: all, in order; the first is the mission as it was.
        best: the one that was found.
        front: for several metrics, all tries of which no other is better in each.
        evidence: on fresh seeds; None where the search was interrupted.
        is_random: whether a mission differs from seed to seed.
    """

    settings: Settings
    recommended: Mission
    runs: int
    tries: tuple[Try, ...]
    best: Try
    front: tuple[Try, ...]
    evidence: Evidence | None
    is_random: bool

    @property
    def mission(self) -> Mission:
        """That was tuned."""
        return self.settings.mission

    @property
    def knobs(self) -> tuple[Knob, ...]:
        """What was varied."""
        return self.settings.knobs

    @property
    def metrics(self) -> tuple[str, ...]:
        """For which."""
        return self.settings.metrics

    @property
    def quantile(self) -> float | None:
        """Of each metric over the runs [-]; None: its mean."""
        return self.settings.quantile

    @property
    def goal(self) -> Goal:
        """What is better."""
        return self.settings.goal

    @property
    def is_better(self) -> bool:
        """Whether the evidence says so."""
        return self.evidence is not None and self.evidence.is_better

    @property
    def is_interrupted(self) -> bool:
        """Whether it ended before its time."""
        return self.evidence is None

    @property
    def start(self) -> Try:
        """The mission as it was."""
        return self.tries[0]


def tune(
    mission: Given,
    vary: Sequence[str],
    metrics: Sequence[str],
    *,
    runs: int = DEFAULT_TUNED,
    evaluations: int = DEFAULT_TRIES,
    quantile: float | None = None,
    met: float = DEFAULT_MET,
    seed: int | None = None,
    overrides: Sequence[str] = (),
    allow_code: Iterable[str | Path] = (),
    resume: str | Path | None = None,
    remember: Remember = lambda settings, tries: None,
    progress: Progress = lambda stage, done, total: None,
    should_stop: Callable[[], bool] = lambda: False,
) -> Tuning:
    """Tune numbers of a mission for a metric, or for several at once.

        found = cardume.tune("paper/figure-5", ["guidance.lookahead=2..15"], ["cross_track_rms"])
        found.best.values, found.evidence.differences

    Every try flies with the same seeds.  What the mission requires comes first: a try in which all is met in fewer
    runs than `met` is worse than any in which it is.

    Args:
        mission: file, name of a built-in mission, or what `load` gave.
        vary: each a key, or `key=low..high`; without ends those of the law, or five times less and more.
        metrics: one to three, of the fleet or as `vehicle.metric`.
        runs: of a try.
        evaluations: how many tries.
        quantile: of a metric over the runs that counts, as 0.95; None for its mean.
        met: share of the runs in which all is to be met that the mission requires.
        seed: of the first run and of the search, instead of the mission's.
        overrides: values to change before, as `--set` takes them.
        allow_code: folders from which laws may be imported.
        resume: directory of the same tuning, interrupted; what was tried there is not flown again, and the end is the
            same.
        remember: called after each try with what is searched and all tries known by now, for whoever keeps them.
        progress: called with "compile", "tune" or "compare", how much is done, and how much there is.
        should_stop: asked every few milliseconds; what was found by then is given.

    Returns:
        What was found, tried and proved.

    Raises:
        InputError: a mission, key, range or metric that cannot be, or a metric without any number.
    """
    folders = tuple(allow_code)
    opened = open_given(mission, overrides, (), folders)
    refuse_sweeps(opened)
    _check(runs, evaluations, quantile, met, metrics)
    asked = check_metrics(metrics, [Arm("", opened, opened.name)], METRICS)
    knobs = make_knobs(opened, vary, catalog(folders))
    wanted = [METRICS[metric.rpartition(".")[2]].wanted for metric in asked]
    settings = Settings(
        mission=opened,
        knobs=knobs,
        metrics=asked,
        quantile=quantile,
        first=opened.seed if seed is None else seed,
        runs=runs,
        evaluations=evaluations,
        goal=Goal(tuple(-1.0 if of == "at least" else 1.0 for of in wanted), met),
        folders=folders,
    )
    settings.check_seeds()
    known = known_tries(Path(resume), settings) if resume else {}
    tries = Tries(settings, progress, should_stop, known, remember)
    _search(tries)
    if not tries.made:
        raise InputError("interrupted before anything was flown")
    tries.complain_if_hopeless(1)
    best = best_of(tries.made, settings.goal)
    evidence = tries.prove(best)
    is_kept = evidence is None or evidence.is_better
    return Tuning(
        settings=settings,
        recommended=with_values(opened, knobs, best.values) if is_kept else opened,
        runs=tries.runs,
        tries=tuple(tries.made),
        best=best,
        front=tuple(front_of(tries.made, settings.goal)) if len(asked) > 1 else (),
        evidence=evidence,
        is_random=tries.is_random,
    )


def _search(tries: Tries) -> None:
    """Try until there are no tries left, or the user says stop."""
    asked = tries.settings
    start = tuple(min(max(knob.share(knob.start), 0.0), 1.0) for knob in asked.knobs)
    looking = search_one if len(asked.metrics) == 1 else search_several
    try:
        tries.begin()
        looking(tries.attempt, start, asked.evaluations - 1, asked.goal, asked.first)
    except Enough:
        pass


def _check(runs: int, evaluations: int, quantile: float | None, met: float, metrics: Sequence[str]) -> None:
    if not 1 <= runs <= MOST_RUNS:
        raise InputError(f"--runs {runs}: give a whole number from 1 to {MOST_RUNS}")
    if not FEWEST_TRIES <= evaluations <= MOST_TRIES:
        raise InputError(f"--evaluations {evaluations}: give a whole number from {FEWEST_TRIES} to {MOST_TRIES}")
    if quantile is not None and not 0.0 < quantile < 1.0:
        raise InputError(f"--quantile {quantile:g}: give a share between 0 and 1, as 0.95")
    if not 0.0 <= met <= 1.0:
        raise InputError(f"--met {met:g}: give a share from 0 to 1, as 0.95")
    if not 1 <= len(set(metrics)) <= MOST_METRICS:
        raise InputError(
            f"{len(set(metrics))} metrics are given; tune for one to {MOST_METRICS}, as --for cross_track_rms"
        )
