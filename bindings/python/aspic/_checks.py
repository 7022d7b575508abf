"""Checks that refuse what would be ignored: unknown attributes, and changes of scenes in use."""
import os

import numpy as np
from numpy.typing import NDArray

from . import _aspic

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


class Strict:
    """Refuses unknown public attributes of the package's own classes."""

    _attributes: tuple[str, ...] = ()
    _advice = ""

    def __setattr__(self, name, value):
        cls = type(self)
        if not (name.startswith("_") or name in cls._attributes or hasattr(cls, name)) and cls.__module__.startswith("aspic."):
            raise AttributeError(f"{cls.__name__} has no attribute '{name}'; {cls._advice.format(name=name)}")
        super().__setattr__(name, value)


def frozen(value):
    """A copy for comparisons."""
    if isinstance(value, dict):
        return tuple((key, frozen(item)) for key, item in value.items())
    if isinstance(value, (list, tuple)):
        return tuple(frozen(item) for item in value)
    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, value.tobytes()
    return value


class SceneState:
    """The state of a scene when something was made of it."""

    def __init__(self, scene, what):
        self._scene, self._what, self._parts = scene, what, scene._parts()

    def require_unchanged(self, remedy=""):
        """Raises RuntimeError if the scene has changed, because `what` would ignore it."""
        now = self._scene._parts()
        if now == self._parts:
            return
        changed = [name for name in {**self._parts, **now} if now.get(name) != self._parts.get(name)]
        raise RuntimeError(f"the scene was changed after this {self._what} was made ({', '.join(changed[:3])}), which has the "
                           f"earlier scene; make another {self._what} of the changed scene{remedy}")


def read_only(array):
    """The array, which refuses writes that would be lost."""
    array.flags.writeable = False
    return array


def is_path(value):
    return isinstance(value, (str, os.PathLike))


def bounded(value, name):
    """The value as an array. Raises InvalidInput if its copies fill the memory."""
    array = np.asarray(value)
    _aspic.require_bounded(array, name)
    return array


def count_of(value, name, least):
    """The value as an int. Raises InvalidInput for fractions, numbers below `least`, and what is no number."""
    if not isinstance(value, (int, float, np.number)) or not least <= value < 2**31 or value != int(value):
        raise _aspic.InvalidInput(f"{name} = {value!r}; expected an integer of at least {least}")
    return int(value)
