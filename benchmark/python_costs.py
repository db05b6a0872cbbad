#!/usr/bin/python3
"""What the Python module costs beside C++, in one thread. Both take turns in one run.

    benchmark/python_costs.py PYTHON_COSTS CONFIG

PYTHON_COSTS is the program of that name, CONFIG the folder of the scenes; PYTHONPATH leads to the module. Prints CSV,
one line for each figure: what, ns in C++, ns in Python, their ratio; each the least of the rounds, as a shared machine
changes its speed by a half from one second to the next.
"""
import csv
import statistics
import subprocess
import sys
import time

import numpy as np

import hybrid_sphere

DURATION = 5.0  # s
OUTPUTS = 1000
RUNS = 1000000
ROUNDS = 11


def ns_of(work, repetitions, before=lambda: None):
    """The median."""
    took = []
    for _ in range(repetitions):
        before()
        start = time.perf_counter()
        work()
        took.append(time.perf_counter() - start)
    return 1e9 * statistics.median(took)


def outputs(scene, repetitions):
    simulation = hybrid_sphere.Simulation(scene)
    times = np.arange(1, OUTPUTS + 1) * DURATION / OUTPUTS
    return ns_of(lambda: simulation.run(times), repetitions, simulation.reset) / OUTPUTS


def runs(scene, fields):
    samples = {"initial_state.velocity[0]": 1 + np.arange(RUNS) / RUNS}
    return ns_of(lambda: hybrid_sphere.run_many(scene, [DURATION], samples, fields=fields), 1) / RUNS


def knife_edge():
    """The catalogue's knife edge on an incline as a system from functions: ns for each evaluation of the equations, in C++
    and in Python."""
    system = hybrid_sphere.catalogue("knife_edge_incline")
    m, inertia, gs, begin = (system.parameters[name] for name in ("m", "I", "gs", "t_switch"))

    def lagrangian(t, q, v):
        return m / 2 * (v[0]**2 + v[1]**2) + inertia / 2 * v[2]**2 + m * gs * q[0]
    own = hybrid_sphere.System(system.coordinates, lagrangian)
    own.constrain("blade", lambda t, q, v: v[0] * np.sin(q[2]) - v[1] * np.cos(q[2]), begin=begin)

    def cost(of):
        start = time.perf_counter()
        evaluations = of.solve(10, system.q, system.v).evaluations
        return 1e9 * (time.perf_counter() - start) / evaluations
    return cost(system), cost(own)


def advance(scene):
    simulation = hybrid_sphere.Simulation(scene)
    times = (np.arange(100000) * DURATION / 100000).tolist()

    def work():
        for each in times:
            simulation.advance(each)
    return ns_of(work, 1) / len(times)


def main():
    program, config = sys.argv[1:]
    scene = {name: "%s/%s.yaml" % (config, name) for name in ("paper", "incline", "turntable")}
    figures = {}
    for _ in range(ROUNDS):
        text = subprocess.run([program], check=True, capture_output=True, text=True).stdout
        cpp = {row["what"]: float(row["ns"]) for row in csv.DictReader(text.splitlines())}
        python = {"outputs paper": outputs(scene["paper"], 2000), "outputs incline": outputs(scene["incline"], 200),
                  "outputs turntable": outputs(scene["turntable"], 50), "runs whole": runs(scene["paper"], []),
                  "runs places": runs(scene["paper"], ["x", "y", "vx", "vy"]), "advance": advance(scene["paper"])}
        cpp["functions"], python["functions"] = knife_edge()
        for what, ns in python.items():
            figures.setdefault(what, []).append((cpp.get(what), ns))
    print("what,cpp_ns,python_ns,ratio")
    for what, pairs in figures.items():
        mine = min(ns for _, ns in pairs)
        if pairs[0][0] is None:
            print("%s,,%.4g," % (what, mine))
        else:
            other = min(ns for ns, _ in pairs)
            print("%s,%.4g,%.4g,%.3g" % (what, other, mine, mine / other))


if __name__ == "__main__":
    main()
