"""Event-driven simulation of hybrid nonholonomic systems: a sphere on smooth and rough ground, and any Lagrangian
system. docs/python.md is the guide.

The compiled part and numpy are loaded when something of it is first used: who imports hybrid_sphere.msg alone does not
wait for them.
"""
from importlib import import_module as _import_module

from ._errors import Halted, SceneError

_PARTS = {
    "_core": ("Simulation", "Runs", "run_many", "write_html", "Model", "System", "MultibodySystem", "Solution", "Plant",
              "Snapshot", "Linearization", "linearize", "equilibrium", "Modes", "modes", "Number", "systems", "catalogue",
              "__version__"),
    "_bodies": ("Twist", "Wrench", "BodyState", "Plane", "ContactShape", "force_at"),
    "_columns": ("columns",),
}
__all__ = ["Halted", "SceneError", *(name for names in _PARTS.values() for name in names)]


def __getattr__(name):
    for part, names in _PARTS.items():
        if name in names:
            module = _import_module("." + part, __name__)
            for each in names:
                globals()[each] = getattr(module, each)
            return globals()[name]
    raise AttributeError("module 'hybrid_sphere' has no attribute '%s'" % name)


def __dir__():
    return sorted({*globals(), *__all__})
