"""Vehicle models: one plant step.

A model gets the true `VesselState`, the `Command` of its autopilot, the `Reference` (a kinematic
model follows it at once) and the `Water` around it, and gives the state one plant step later.
"""

from collections.abc import Callable
from types import FunctionType

from cardume.laws import Law, law_family
from cardume.signals import Command, Reference, VesselState, Water

vehicle_model, step_vehicle = law_family("model", (VesselState, Command, Reference, Water), VesselState)


def announce(model: Law, **numbers: dict[str, float]) -> None:
    """Say what others aboard believe of a vehicle unless a mission says otherwise: hull, thrusters, gains that suit it.

    A parameter of that family that has one of these names has this default beside the model. Announced is what the
    model is by itself: a mission that changes the model's numbers changes the truth, not what is believed of it.

    Args:
        model: the vehicle.
        numbers: by family, such as `autopilot` and `speed`: values of parameters, in their units.
    """
    model.announced.update(numbers)


def variant_of(model: Law, **defaults: float) -> Callable[[Callable[[], None]], Law]:
    """The same equations with other numbers: a model of its own, named and described by the function decorated.

    Args:
        model: whose equations and parameters it has.
        defaults: [any] of the parameters that differ, in their units.

    Returns:
        A decorator for a function without a body, whose docstring leaves out `Args`: these are the model's.

    Raises:
        TypeError: the model has no parameter of that name.
    """
    known = [parameter.name for parameter in model.parameters]
    if unknown := defaults.keys() - set(known):
        raise TypeError(f"{model.name} has no parameter {sorted(unknown)}; it has {known}")

    def make(described: Callable[[], None]) -> Law:
        old = model.function
        new = FunctionType(old.__code__, old.__globals__, described.__name__, old.__defaults__, old.__closure__)
        new.__annotations__ = old.__annotations__
        new.__module__, new.__qualname__ = described.__module__, described.__qualname__
        head, _, source = (described.__doc__ or "").partition("    Source:")
        new.__doc__ = f"{head}    Args:{_arguments_in(model.doc_of_parameters)}    Source:{source}"
        law: Law = vehicle_model(new)
        law.parameters = tuple(p._replace(default=defaults.get(p.name, p.default)) for p in law.parameters)
        return law

    return make


def _arguments_in(doc: str) -> str:
    """What a docstring says of arguments and results."""
    return doc.partition("    Args:")[2].partition("    Source:")[0].rstrip() + "\n\n"
