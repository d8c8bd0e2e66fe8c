#!/usr/bin/env python3
"""Where the instructions of a sample go, stage by stage, and what its rays do.

    python3 benches/stages.py --scenes b
    python3 benches/stages.py --scenes a,b,d --integrator path

Renders three samples a pixel and one under callgrind and takes the difference, so that loading cancels.
Nearly all of a sample is inlined into a few functions. So instructions are counted by address, the program's line
tables tell which functions each was inlined from, and the innermost that belongs to a stage has it. Caches and
branches are simulated: a first level as the machine has, a second of 512 KiB, no prefetching.
"""

import argparse
import re
import subprocess
import sys
from bisect import bisect_right
from collections import Counter, defaultdict

import measure

CLOSEST, SHADOW = "closest-hit rays", "shadow rays"
# Stage, file, function (patterns): the first that fits a frame. Helpers fit nothing and belong to who called them.
RULES = [(stage, re.compile(file), re.compile(function)) for stage, file, function in [
    (SHADOW, r"bvh/", r"any_hit|is_hit|is_sphere_hit|occluded"),
    (CLOSEST, r"bvh/", r"first_hit|test_leaf|test_spheres|push_sorted|finish|closest$"),
    ("sample numbers", r"math/src/(stream|strata)\.rs|transport/src/numbers\.rs", r""),
    ("camera and film position", r"scene/src/camera\.rs", r"ray"),
    ("camera and film position", r"math/src/filter\.rs", r"sample"),
    ("camera and film position", r"transport/src/kernel\.rs", r"eye_sample|camera_flight"),
    ("splats and film", r"film/src|bdpt/splat\.rs|scene/src/camera\.rs|light_tracer\.rs|render/src/session\.rs", r""),
    ("splats and film", r"transport/src/kernel\.rs", r"splat|reaches_window|is_seen"),
    ("BSDFs", r"scene/src/bsdf/", r""),
    ("lamps", r"scene/src/light/|math/src/(spherical|distribution)\.rs", r""),
    ("surface points and vertices",
     r"scene/src/(surface|scene|material|texture)\.rs|transport/src/vertex\.rs", r""),
    ("connections and weights", r"bdpt/(candidate|connection|hit|next_event)\.rs|transport/src/(weight|edge|strategy)\.rs", r""),
    ("connections and weights", r"bdpt/mod\.rs|walk\.rs", r"finish|weigh|report|first_sums|step|escape|joined"),
    ("walks", r"transport/src/(walk|path_tracer|direct_views)\.rs|bdpt/mod\.rs", r""),
]]
OPTIONS = ["--dump-instr=yes", "--cache-sim=yes", "--branch-sim=yes", f"--LL={measure.LEVEL_2}"]
# What is shown, and the events that make it up.
COLUMNS = {"instructions": ["Ir"], "level-1 misses": ["D1mr", "D1mw"], "level-2 misses": ["DLmr", "DLmw"],
           "mispredictions": ["Bcm", "Bim"]}
RAYS = {CLOSEST: re.compile(r"(avx2|traverse)::closest"), SHADOW: re.compile(r"(avx2|traverse)::occluded")}
# Functions of lanes and their callers in `scene/src/bvh`.
VISITS = {("le", "enter"): "nodes", ("ge", "test"): "blocks", ("le", "enter_triangles"): "boxes"}


def read(file, binary):
    """Counts of a callgrind file: by (in the program?, address), and calls by callee."""
    events, by_address, calls = [], defaultdict(Counter), Counter()
    inside, callee, skip = False, "", False
    with open(file) as lines:
        for line in lines:
            if line.startswith(("0x", "0X")):
                if skip:
                    skip = False
                    continue
                fields = line.split()
                counts = dict(zip(events, map(int, fields[2:])))
                by_address[inside, int(fields[0], 16)].update(counts)
            elif line.startswith("calls="):
                calls[callee] += int(line[6:].split()[0])
                skip = True
            elif line.startswith("cfn="):
                callee = line[4:].strip()
            elif line.startswith("ob="):
                inside = line[3:].strip().endswith(f"/{binary.name}")
            elif line.startswith("events:"):
                events = line.split()[1:]
    return by_address, calls


def difference(more, fewer):
    """Counts of one sample a pixel more."""
    result = {}
    for key, counts in more.items():
        less = fewer.get(key, {})
        result[key] = {e: n - less.get(e, 0) for e, n in counts.items()}
    return result


def frames(binary, addresses):
    """For each address the functions that it was inlined from, innermost first, as pairs of name and file."""
    asked = "\n".join(f"{a:#x}" for a in addresses)
    told = subprocess.run(["addr2line", "-a", "-f", "-i", "-C", "-e", str(binary)], input=asked, capture_output=True,
                          text=True, check=True).stdout
    result, chain, name = {}, [], None
    for line in told.splitlines():
        if re.fullmatch(r"0x[0-9a-f]+", line):
            chain = result.setdefault(int(line, 16), [])
            name = None
        elif name is None:
            name = line
        else:
            chain.append((name, file_of(name, line)))
            name = None
    return result


def file_of(name, place):
    """The file of a frame; made up from the function's name where the line tables do not tell it."""
    if place.startswith("??") and (path := re.match(r"caustica_(\w+)::(.+)::\w+$", name)):
        return f"{path[1]}/src/{path[2].replace('::', '/')}.rs"
    return place.rsplit(":", 1)[0]


def stage_of(chain):
    """The stage of an instruction."""
    for name, file in chain:
        for stage, file_pattern, name_pattern in RULES:
            if file_pattern.search(file) and name_pattern.search(name):
                return stage
    return "floor and ceil" if any(re.search(r"\b(floor|ceil)f?$", name) for name, _ in chain) else "rest"


def is_output(chain):
    """Whether an instruction writes the picture, whose length depends on what is in it."""
    return any(measure.OUTPUT.search(place) for frame in chain for place in frame)


def compares(binary, addresses):
    """Those addresses that hold a comparison of vectors."""
    first, last = min(addresses), max(addresses)
    text = subprocess.run(["objdump", "-d", "--no-show-raw-insn", f"--start-address={first:#x}",
                           f"--stop-address={last + 16:#x}", str(binary)], capture_output=True, text=True).stdout
    found = re.findall(r"^\s*([0-9a-f]+):\s+v?cmp\w*ps\b", text, re.M)
    return {int(a, 16) for a in found} & set(addresses)


def visit_of(chain):
    """What an instruction of a ray asks of: a node's boxes, a block of triangles, or the boxes of those."""
    names = [name.split("<")[0].rsplit("::", 1)[-1] for name, _ in chain]
    for asker, asked in zip(names, names[1:]):
        if (asker, asked) in VISITS:
            return VISITS[asker, asked]
    return None


def visits(binary, counts, chains, samples):
    """How often the rays of each kind ask what: each question has one comparison of its own, on AVX lanes."""
    places = {}
    for inside, address in counts:
        chain = chains.get(address, [])
        visit = visit_of(chain) if inside else None
        if visit and stage_of(chain) in RAYS:
            places[address] = (stage_of(chain), visit)
    result = {kind: Counter() for kind in RAYS}
    for address in compares(binary, places) if places else ():
        kind, visit = places[address]
        result[kind][visit] += counts[True, address]["Ir"] / samples
    return result


def profile(options, scene):
    """Counts by stage, calls and visits, a sample."""
    samples = 2 * measure.SIZE[0] * measure.SIZE[1]
    runs = []
    for spp in (1, 3):
        file = measure.callgrind(options.binary, scene, options.integrator, spp, options.work, OPTIONS)
        runs.append(read(file, options.binary))
        file.unlink()
    counts = difference(runs[1][0], runs[0][0])
    counts = {key: c for key, c in counts.items() if c.get("Ir", 0)}
    chains = frames(options.binary, sorted(a for inside, a in counts if inside))
    counts = {(inside, a): c for (inside, a), c in counts.items() if not is_output(chains.get(a, []))}
    stages = defaultdict(Counter)
    for (inside, address), c in counts.items():
        stage = stage_of(chains.get(address, [])) if inside else "system libraries"
        for event, n in c.items():
            stages[stage][event] += n / samples
    calls = {kind: sum(runs[1][1][f] - runs[0][1][f] for f in runs[1][1] if pattern.search(f)) / samples
             for kind, pattern in RAYS.items()}
    if options.detail:
        show_detail(options.detail, counts, chains, samples)
    return stages, calls, visits(options.binary, counts, chains, samples)


def show_detail(stage, counts, chains, samples):
    """The functions of one stage that take most, and who they were inlined into."""
    found = Counter()
    for (inside, address), c in counts.items():
        chain = chains.get(address, [])
        if inside and stage_of(chain) == stage:
            found[" < ".join(name for name, _ in chain[:5])] += c["Ir"] / samples
    for chain, n in found.most_common(25):
        print(f"{n:10.1f}  {chain}", file=sys.stderr)


def show(name, integrator, stages, calls, visited):
    """Prints a scene's tables."""
    total = Counter()
    for counts in stages.values():
        total.update(counts)
    print(f"\n### {name}, {integrator}: a sample\n\n| stage | share | " + " | ".join(COLUMNS) + " |")
    print("|---|--:|" + "--:|" * len(COLUMNS))
    rows = sorted(stages.items(), key=lambda item: -item[1]["Ir"]) + [("all", total)]
    for stage, counts in rows:
        values = [sum(counts[e] for e in events) for events in COLUMNS.values()]
        shown = " | ".join(f"{v:,.0f}" if v >= 100 else f"{v:.1f}" for v in values)
        print(f"| {stage} | {counts['Ir'] / total['Ir']:.1%} | {shown} |")
    print("\n| rays | a sample | instructions a ray | nodes a ray | blocks a ray | of these, hit inside |\n"
          "|---|--:|--:|--:|--:|--:|")
    for kind in RAYS:
        rays, v = calls[kind], visited[kind]
        if rays:
            print(f"| {kind} | {rays:.2f} | {stages[kind]['Ir'] / rays:.0f} | {v['nodes'] / rays:.2f} | "
                  f"{v['blocks'] / rays:.2f} | {v['boxes'] / rays:.2f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    measure.arguments(parser)
    parser.add_argument("--integrator", default="bdpt")
    parser.add_argument("--detail", metavar="STAGE", help="also tell which functions make up a stage, such as `rest`")
    options = parser.parse_args()
    if not measure.has_valgrind():
        return
    options.work.mkdir(parents=True, exist_ok=True)
    for name, scene in measure.scenes(options):
        show(name, options.integrator, *profile(options, scene))


if __name__ == "__main__":
    main()
