"""Columns of the arrays of motions, side by side."""
import numpy as np


def columns(rows, names):
    """Several columns of states or of switches as one array of floats.

    rows   one item, or an array, of what Solution.at, Solution.switches, Plant.run, ... return
    names  names of columns, such as System.coordinates; or one name, such as "lambda_pivot", for a column, or for
           the columns "lambda_pivot_1", "lambda_pivot_2", ... of a constraint of several functions

    Returns an array whose last axis has the columns: (k,) for one item, (n, k) for an array of n.

    Raises ValueError for a name that is no column.
    """
    known = rows.dtype.names or ()
    if isinstance(names, str):
        names = [names] if names in known else _components(names, known)
    for name in names:
        if name not in known:
            raise ValueError("there is no column %r; allowed: %s" % (name, ", ".join(known)))
    if not len(names):
        return np.empty((*np.shape(rows), 0))
    return np.stack([np.asarray(rows[name], float) for name in names], axis=-1)


def _components(name, known):
    """name_1, name_2, ... as far as they are there; name itself where none is."""
    found = []
    while "%s_%d" % (name, len(found) + 1) in known:
        found.append("%s_%d" % (name, len(found) + 1))
    return found or [name]
