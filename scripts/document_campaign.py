#!/usr/bin/python3
"""Runs each check of generated_scenes over its number of scenes and writes the table of docs/reliability.md.

    document_campaign.py PROGRAM DIRECTORY SHARE [OPTION...]

The scenes are judged in blocks, whose outputs stay in DIRECTORY. The page tells how far a check has come: a run that was
stopped goes on there, as long as sources, share and options are the same. Exit code 1 where a claim does not hold.
"""
import collections
import hashlib
import os
import pathlib
import re
import subprocess
import sys

from write_figures import figures, write_figures

ROOT = pathlib.Path(__file__).resolve().parent.parent
CHECKS = [("relations", 100000), ("integrator", 40000), ("invariants", 1000000), ("invariants --hostile", 10000)]
BLOCK = {"invariants": 25000, "integrator": 1000, "relations": 5000}
COUNTS = ["held", "halted", "refused", "say nothing", "findings"]
# Files of fuzz/, by the beginnings of their names, that judge for one check alone.
OWN_FILES = {"integrator": ["judge_by_integrator", "own_"], "relations": ["judge_relations"]}
LAST_LINE = re.compile(r"^(\d+) scenes in (\S+) s \(\S+ a minute\): " + ", ".join(rf"(\d+) {c}" for c in COUNTS) + "$")


def sources(check):
    """A short name of what is tested and of what tests it, the same on every machine."""
    others = [name for judge, names in OWN_FILES.items() if judge != check.split()[0] for name in names]
    unused = set() if check == "fuzz" else {"ros", "targets"}
    files = sorted(file for folder in ("src", "include", "fuzz") for file in (ROOT / folder).rglob("*.[ch]pp")
                   if not unused & set(file.parts) and not file.name.startswith(tuple(others)))
    digest = hashlib.sha256()
    for file in files:
        digest.update(str(file.relative_to(ROOT)).encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()[:12]


def block_of(program, directory, words, first, scenes):
    """The output of a block of scenes, judged now or before."""
    key = hashlib.sha256(program.read_bytes() + " ".join(words).encode()).hexdigest()[:16]
    log = directory / f"{key}_{first}_{scenes}.log"
    if not log.exists():
        command = [program, "--processes", str(os.cpu_count()), "--no-shrink", *words,
                   "--first", str(first), "--scenes", str(scenes)]
        run = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
        if run.returncode not in (0, 1):
            sys.exit(f"campaign: {' '.join(map(str, command))} exited with code {run.returncode}")
        part = log.with_suffix(".part")
        part.write_text(run.stdout)
        part.rename(log)
    return log.read_text()


def row_of(check, name, sums):
    """A row of the table: sources, scenes, rate and counts so far."""
    cells = [sums[0], 60 * sums[0] / sums[1], *sums[2:]]
    return " | ".join([f"| `--check {check}`", f"`{name}`", *(f"{cell:.0f}" for cell in cells)]) + " |"


def sums_of(row):
    """The other way round."""
    scenes, rate, *counts = (float(cell) for cell in row.strip("| ").split(" | ")[2:])
    return [scenes, 60 * scenes / rate, *counts]


def judge_block(program, directory, check, first, scenes, options):
    """Scenes, seconds and counts of a block; prints what it has found."""
    output = block_of(program, directory, ["--check", *check.split(), *options], first, scenes)
    lines = output.splitlines()
    counts = [float(word) for word in LAST_LINE.match(lines[-1]).groups()]
    if counts[-1] > 0:
        print("\n".join(line[:200] for line in lines if not line.startswith("  refused"))[:10000])
    return counts


def parts_of(scene):
    """The laws and forces that a printed scene has."""
    parts = set(re.findall(r"law: (\w+)", scene))
    optional = ["rolling_resistance", "spin_friction", "spring", "belt", "turntable"]
    parts |= {part for part in optional if f" {part}: " in scene}
    drag = re.search(r"drag: {translational: (\S+), rotational: (\S+), quadratic: (\S+)}", scene).groups()
    names = ["translational drag", "rotational drag", "quadratic drag"]
    parts |= {name for name, value in zip(names, drag) if float(value) != 0}
    numbers = {"slope": r"gravity: \[(\S+), (\S+),", "force": r"force: \[(\S+), (\S+)\]",
               "torque": r"torque: \[(.+), (.+), (.+)\]"}
    parts |= {part for part, text in numbers.items() if any(map(float, re.search(text, scene).groups()))}
    return {part.replace("_", " ") for part in parts}


def count_parts(program, scenes, options):
    """A sentence that tells in how many scenes of the integrator each law and force is."""
    command = [program, "--print", *options, "--scenes", str(scenes)]
    printed = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.split("--- # seed")[1:]
    counts = collections.Counter(part for scene in printed for part in parts_of(scene))
    listed = ", ".join(f"{part} in {count}" for part, count in counts.most_common())
    write_figures("reliability.md", "campaign parts", f"Of the {len(printed)} scenes of the integrator: {listed}.")


def main():
    program, directory = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    share, options = float(sys.argv[3]), sys.argv[4:]
    directory.mkdir(parents=True, exist_ok=True)
    columns = ["check", "sources", "scenes", "a minute", "held", "halted with a reason", *COUNTS[2:]]
    command = " ".join(["scripts/campaign --document", *sys.argv[3:]])
    head = [f"`{command}`, each check of the core, the generator and its judge as they were:", "",
            "| " + " | ".join(columns) + " |", "| " + " | ".join("---" for _ in columns) + " |"]
    written = figures("reliability.md", "campaign").splitlines()
    rows = written[len(head):] if written[:len(head)] == head else []
    names = {check: sources(check) for check, _ in CHECKS}
    known = {row.split("`")[1].removeprefix("--check "): row for row in rows}
    so_far = {check: sums_of(row) for check, row in known.items() if f" `{names[check]}` " in row}
    for check, scenes in CHECKS:
        most = max(1, round(share * scenes))
        sums = so_far.setdefault(check, [0.0] * (2 + len(COUNTS)))
        while sums[0] < most:
            first = round(sums[0])
            block = judge_block(program, directory, check, first, min(BLOCK[check.split()[0]], most - first), options)
            sums[:] = [a + b for a, b in zip(sums, block)]
            table = [row_of(check, names[check], sums) for check, sums in so_far.items()]
            write_figures("reliability.md", "campaign", "\n".join([*head, *table]))
            print(f"--check {check}: {sums[0]:.0f} of {most} scenes", flush=True)
        print(f"--check {check}: {sums[0]:.0f} scenes, {sums[-1]:.0f} findings", flush=True)
    count_parts(program, max(1, round(share * dict(CHECKS)["integrator"])), options)
    sys.exit(any(sums[-1] > 0 for sums in so_far.values()))


if __name__ == "__main__":
    main()
