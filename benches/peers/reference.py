"""Reference images, made of independent batches, and the check that all engines have the same mean."""

import hashlib

import numpy as np

import metrics

# Which engine renders the reference of a scene: the one that is best at it. Who else agrees is what `check` is for.
ENGINE = {"a": "caustica-path", "b": "caustica-bdpt", "c": "caustica-bdpt", "d": "caustica-bdpt"}
# Measured renders have seeds of their own, far below these.
REFERENCE_SEED, CHECK_SEED = 1000, 5000


def batches(runner, name, scene_name, folder, seconds, count, first_seed, cache):
    """`count` independent images that take `seconds` in all; kept in the folder `cache` for the next time."""
    description = "".join((folder / file).read_text() for file in ("caustica.xml", "mitsuba.xml", "luxcore.scn"))
    meshes = b"".join(path.read_bytes() for path in sorted(folder.glob("*.ply")))
    scene_key = hashlib.sha256(description.replace(str(folder.resolve()), "").encode() + meshes).hexdigest()[:10]
    path = cache / f"{scene_name}-{name}-{seconds:g}s-{count}-{first_seed}-{scene_key}.npz"
    if not path.exists():
        print(f"({scene_name}) {name}: {count} batches in {seconds:g} s …", flush=True)
        renders = [runner.render(name, folder, seconds / count, first_seed + k) for k in range(count)]
        cache.mkdir(parents=True, exist_ok=True)
        # Batches of different length have different noise; equal weights are close enough and leave no room for bias.
        np.savez(path, images=np.stack([r.image for r in renders]), samples=sum(r.samples for r in renders))
    with np.load(path) as found:
        return found["images"], float(found["samples"])


class Reference:
    """The mean of all batches, and how noisy it is."""

    def __init__(self, images, samples):
        self.images, self.samples = images, samples
        self.image = images.mean(axis=0, dtype=np.float64).astype(np.float32)
        mean, error = metrics.mean_and_error([metrics.luminance(image).mean() for image in images])
        self.mean, self.mean_error = float(mean), float(error)
        # Half the difference of two halves has the variance of the mean of both.
        halves = images[::2].mean(axis=0, dtype=np.float64), images[1::2].mean(axis=0, dtype=np.float64)
        alike = self.image + (halves[0] - halves[1]) / 2
        self.rel_mse = metrics.rel_mse(alike, self.image)
        self.trimmed = metrics.rel_mse(alike, self.image, trim=0.001)


def check(runner, names, scene_name, folder, reference, seconds, count, cache):
    """Prints how the means of `names` differ from the reference's, with standard errors; returns the rows."""
    rows = []
    print(f"\n({scene_name}) means against the reference "
          f"({ENGINE[scene_name]}, {reference.mean:.5f} ± {100 * reference.mean_error / reference.mean:.3f} %), "
          f"{seconds:g} s each")
    print(f"{'engine':<22}{'spp':>8}{'deviation':>12}{'± (s.e.)':>10}{'blocks: rms':>13}{'rms z':>8}{'max z':>8}")
    for name in names:
        images, samples = batches(runner, name, scene_name, folder, seconds, count, CHECK_SEED, cache)
        own = reference.images[:, :images.shape[1]]
        row = {"engine": name, "samples": samples, **metrics.agreement(images, own)}
        rows.append(row)
        print(f"{name:<22}{samples:>8.0f}{row['deviation']:>+11.3f}%{row['error']:>9.3f}%"
              f"{row['block_deviation']:>12.3f}%{row['rms_z']:>8.2f}{row['max_z']:>8.2f}")
    return rows
