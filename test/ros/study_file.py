"""A file as `study` writes it, made of columns that a test may change before."""
import h5py
import numpy as np

SCENE = """
sphere: {mass: 1, radius: 0.1, body: solid}
surface:
  base: {law: smooth}
  regions: [{name: goal, circle: {center: [1, 0], radius: 0.5}, law: rough}]
"""
RUNS = 5000
INDICES = {"first": [[0.1, 0.05, 0.15], [0.6, 0.5, 0.7]], "total": [[0.3, 0.2, 0.4], [0.8, 0.75, 0.85]]}


def texts(*values):
    return np.array([value.encode() for value in values])


def columns(random):
    """What a study leaves; of every tenth run the end is missing, and every fourth does not come to the goal."""
    missing, far = np.arange(RUNS) % 10 == 3, np.arange(RUNS) % 4 == 1
    position = random.normal((1, 0), (0.3, 0.2), (RUNS, 2))
    velocity = random.normal(size=(RUNS, 2))
    position[missing] = velocity[missing] = np.nan
    return {"samples/sphere.mass": random.uniform(1, 2, RUNS), "samples/surface.regions[a%2Fb].friction": np.ones(RUNS),
            "end/position": position, "end/velocity": velocity,
            "end/mode": np.where(missing, -1, np.arange(RUNS) % 2).astype(np.int32),
            "entered": np.where(far, np.nan, random.exponential(size=RUNS))[:, None],
            "switches/count": np.where(missing, -1, random.poisson(3, RUNS)).astype(np.int32),
            "outcome": np.where(missing, 1, 0).astype(np.int32)}


def write_study(path, kept, sensitivity):
    """@param kept  columns by their names  @param sensitivity  first and total indices of each output"""
    with h5py.File(path, "w") as file:
        file.attrs["format"] = np.bytes_("hybrid_sphere study 1")
        file.attrs["runs"] = np.uint64(RUNS)
        file["outcomes"] = [np.count_nonzero(kept["outcome"] == i) for i in range(3)]
        file["scene"] = texts(SCENE)
        file["variables"] = texts("sphere.mass", "surface.regions[a/b].friction")
        file["entered_regions"] = texts("goal")
        for column, values in kept.items():
            file[column] = values
        if "end/position" in file:
            file["end/position"].attrs["unit"] = np.bytes_("m")
        file["names/mode"] = texts("free", "rolling", "sliding")
        file["names/outcome"] = texts("done", "halted", "refused")
        for output, indices in sensitivity.items():
            for kind, rows in indices.items():
                file["sensitivity/%s/%s" % (output, kind)] = np.array(rows, dtype=float)
