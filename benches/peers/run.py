#!/usr/bin/env python3
"""Compares Caustica with Mitsuba 3 and LuxCore at equal time. README.md beside this file tells how and why.

    python3 benches/peers/run.py --environment DIR [--scenes a,b] [--engines …] [--times 10,60]
"""

import argparse
import json
import os
import platform
import sys
from pathlib import Path

import environment

DEFAULT_ENGINES = ["mitsuba-path", "luxcore-path", "luxcore-hybrid", "luxcore-bidir", "caustica-path", "caustica-bdpt"]
CHECKED_ENGINES = ["mitsuba-path", "mitsuba-ptracer", "caustica-path", "caustica-bdpt"]
DEFAULT_WORK = Path(__file__).resolve().parent.parent.parent / "target" / "peers"
BASELINE = "mitsuba-path"
# What is aimed at: scene, engine, which error, and how many times the baseline's it may be.
GOALS = {"a": ("caustica-path", "rel_mse", 0.7), "b": ("caustica-bdpt", "rel_mse", 0.18),
         "c": ("caustica-bdpt", "rel_mse", 0.02), "d": ("caustica-bdpt", "trimmed", 0.007)}


def parsed():
    """The command line's arguments."""
    def words(text):
        return text.split(",")

    def seconds(text):
        return [float(word) for word in text.split(",")]

    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--environment", metavar="DIR", help="Python environment with the peers; made if it is missing")
    p.add_argument("--caustica", metavar="PROGRAM", help="program to measure (default: this repository's release build)")
    p.add_argument("--scenes", type=words, default=["a", "b", "c", "d"])
    p.add_argument("--engines", type=words, default=DEFAULT_ENGINES)
    p.add_argument("--times", type=seconds, default=[10.0, 60.0], help="seconds of rendering")
    p.add_argument("--threads", type=int, default=os.cpu_count())
    p.add_argument("--work", metavar="DIR", default=DEFAULT_WORK, help="scenes, references, previews and reports")
    p.add_argument("--seed", type=int, default=1, help="seed of the measured renders, below 1000")
    p.add_argument("--repeats", type=int, default=1, help="renders of each kind, with seeds of their own, averaged")
    p.add_argument("--reference-time", type=float, default=600, help="seconds for each reference")
    p.add_argument("--batches", type=int, default=16, help="independent parts of references and checks")
    p.add_argument("--check", action="store_true", help="compare the means in long runs instead of measuring")
    p.add_argument("--check-engines", type=words, default=CHECKED_ENGINES)
    p.add_argument("--check-time", type=float, default=300, help="seconds for each engine and scene")
    return p.parse_args()


def measure(runner, name, scene_name, folder, reference, seconds, options):
    """A row of the table: the means over the renders with different seeds."""
    rows = [measure_once(runner, name, scene_name, folder, reference, seconds, options, options.seed + k)
            for k in range(options.repeats)]
    mean = {key: sum(row[key] for row in rows) / len(rows) for key in rows[0]}
    variants = {"variant": runner.mitsuba_variant(folder)} if name == BASELINE else {}
    return {"scene": scene_name, "engine": name, "time": seconds, **variants, **mean,
            "rel_mse_of_each": [row["rel_mse"] for row in rows], "trimmed_of_each": [row["trimmed"] for row in rows]}


def measure_once(runner, name, scene_name, folder, reference, seconds, options, seed):
    """One render and its errors. Missing rows are left out, and a brightness known to be wrong is corrected."""
    import metrics
    import peers
    import scenes
    render = runner.render(name, folder, seconds, seed)
    truth = reference.image[:len(render.image)]
    ratio = float(metrics.luminance(render.image).mean() / metrics.luminance(truth).mean())
    image = render.image / ratio if peers.ENGINES[name].rescaled else render.image
    peers.write_png(image, Path(options.work) / f"{scene_name}-{name}-{seconds:g}s.png")
    return {"seconds": render.seconds, "cpu": render.cpu, "spp": render.samples,
            "samples_per_second": render.samples * scenes.WIDTH * scenes.HEIGHT / render.seconds,
            "mean_deviation_percent": 100 * (ratio - 1),
            "rel_mse": metrics.rel_mse(image, truth), "trimmed": metrics.rel_mse(image, truth, trim=0.001)}


def print_table(rows, reference):
    """The rows of one scene and time; ratios are to the baseline."""
    first = rows[0]
    print(f"\n({first['scene']}) at {first['time']:g} s; the reference's own relMSE: {reference.rel_mse:.2e}, "
          f"trimmed {reference.trimmed:.2e}")
    print(f"{'engine':<21}{'spp':>7}{'M samples/s':>12}{'seconds':>9}{'cpu':>6}{'mean':>9}{'relMSE':>11}{'trimmed':>11}"
          f"{'÷ base':>9}{'÷ base, tr.':>12}")
    base = next((row for row in rows if row["engine"] == BASELINE), None)
    for row in rows:
        for key in ("rel_mse", "trimmed"):
            row[key + "_ratio"] = row[key] / base[key] if base else None
        ratios = [f"{row[key]:.4f}" if base else "–" for key in ("rel_mse_ratio", "trimmed_ratio")]
        print(f"{row['engine']:<21}{row['spp']:>7.1f}{row['samples_per_second'] / 1e6:>12.3f}{row['seconds']:>9.2f}"
              f"{row['cpu']:>6.0%}{row['mean_deviation_percent']:>+8.2f}%{row['rel_mse']:>11.3e}{row['trimmed']:>11.3e}"
              f"{ratios[0]:>9}{ratios[1]:>12}")
    for line in goals(rows):
        print(line)


def goals(rows):
    """Sentences about what is aimed at, for what was measured."""
    name, key, limit = GOALS[rows[0]["scene"]]
    ours = next((row for row in rows if row["engine"] == name), None)
    if ours is None:
        return
    if ours.get(key + "_ratio") is not None:
        met = "met" if ours[key + "_ratio"] <= limit else "NOT met"
        yield f"  goal: {name} at most {limit} × {BASELINE} ({key}): {ours[key + '_ratio']:.4f}, {met}"
    for row in rows:
        if row["engine"].startswith("luxcore"):
            share, trimmed = ours["rel_mse"] / row["rel_mse"], ours["trimmed"] / row["trimmed"]
            yield (f"  goal: {name} at most 0.5 × {row['engine']}: {share:.4f}, trimmed {trimmed:.4f}, "
                   f"{'met' if max(share, trimmed) <= 0.5 else 'NOT met'}")


def main():
    options = parsed()
    if options.environment:
        environment.enter(options.environment)
    import peers
    import reference as references
    import scenes
    work, cache = Path(options.work), Path(options.work) / "cache"
    runner = peers.Runner(peers.find_caustica(options.caustica), options.threads)
    report = {"caustica": str(runner.caustica), "threads": options.threads, "machine": platform.platform(),
              "width": scenes.WIDTH, "height": scenes.HEIGHT, "max_depth": scenes.MAX_DEPTH, "scenes": {}}
    for scene_name in options.scenes:
        folder = scenes.export(scene_name, work / "scenes" / scene_name)
        truth = references.Reference(*references.batches(
            runner, references.ENGINE[scene_name], scene_name, folder, options.reference_time, options.batches,
            references.REFERENCE_SEED, cache))
        peers.write_png(truth.image, work / f"{scene_name}-reference.png")
        entry = report["scenes"][scene_name] = {
            "title": scenes.SCENES[scene_name][0], "reference": references.ENGINE[scene_name],
            "reference_spp": truth.samples, "reference_mean": truth.mean, "reference_mean_error": truth.mean_error,
            "reference_rel_mse": truth.rel_mse, "reference_trimmed": truth.trimmed}
        if options.check:
            entry["check"] = references.check(runner, options.check_engines, scene_name, folder, truth,
                                              options.check_time, options.batches, cache)
        else:
            entry["rows"] = []
            for seconds in options.times:
                rows = [measure(runner, name, scene_name, folder, truth, seconds, options) for name in options.engines]
                print_table(rows, truth)
                entry["rows"] += rows
        report_name = "check.json" if options.check else "report.json"
        (work / report_name).write_text(json.dumps(report, indent=1) + "\n")
    print(f"\nwritten: {work}/{report_name} and previews")


if __name__ == "__main__":
    sys.exit(main())
