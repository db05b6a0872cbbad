"""Event-driven simulation of hybrid nonholonomic systems: a sphere on smooth and rough ground, and any Lagrangian
system. docs/python.md is the guide.

The compiled part and numpy are loaded when something of it is first used: who imports hybrid_sphere.msg alone does not
wait for them.
"""
from ._errors import Halted, SceneError

_COMPILED = ("Simulation", "Runs", "run_many", "write_html", "System", "Solution", "Plant", "Snapshot", "Number", "systems",
             "catalogue", "__version__")
__all__ = ["Halted", "SceneError", *_COMPILED]


def __getattr__(name):
    if name not in _COMPILED:
        raise AttributeError("module 'hybrid_sphere' has no attribute '%s'" % name)
    from . import _core
    for each in _COMPILED:
        globals()[each] = getattr(_core, each)
    return globals()[name]


def __dir__():
    return sorted({*globals(), *__all__})
