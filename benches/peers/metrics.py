"""How far an image is from its reference, and whether two sets of images have the same mean."""

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def luminance(image):
    """The luminance of linear sRGB, over the last axis."""
    return image @ LUMINANCE


def pixel_errors(image, reference):
    """The relative squared error of each pixel, averaged over the channels.

    (x − r)² / (r² + ε) with ε = 1 % of the squared mean luminance of the reference: scaling both images changes nothing,
    and pixels that are dark beside the rest of the image do not outweigh it.
    """
    x, r = np.asarray(image, float), np.asarray(reference, float)
    epsilon = 0.01 * np.mean(luminance(r)) ** 2
    return np.mean((x - r) ** 2 / (r ** 2 + epsilon), axis=-1)


def rel_mse(image, reference, trim=0.0):
    """The mean of `pixel_errors`, with the worst share `trim` of the pixels left out."""
    errors = np.sort(pixel_errors(image, reference), axis=None)
    return float(np.mean(errors[:len(errors) - round(trim * len(errors))]))


def mean_and_error(batches):
    """The mean over independent batches (first axis) and its standard error."""
    batches = np.asarray(batches, float)
    return batches.mean(axis=0), batches.std(axis=0, ddof=1) / len(batches) ** 0.5


def block_means(image, block=50):
    """Mean luminance of square blocks; what is left over at the right and below is dropped."""
    y = luminance(np.asarray(image, float))
    rows, columns = y.shape[0] // block, y.shape[1] // block
    return y[:rows * block, :columns * block].reshape(rows, block, columns, block).mean(axis=(1, 3))


def agreement(batches, reference_batches, block=50):
    """Compares two sets of independent renders of one scene.

    Returns a dict: `deviation` of the mean luminance in % and its standard `error`; `rms_z` and `max_z` of the blocks'
    differences in standard errors (about 1 and below 4 where the two agree); and `block_deviation`, the root mean square
    of the blocks' differences in %.
    """
    def summary(images):
        means, mean_error = mean_and_error([luminance(np.asarray(i, float)).mean() for i in images])
        blocks, block_error = mean_and_error([block_means(i, block) for i in images])
        return means, mean_error, blocks, block_error

    mean, error, blocks, block_error = summary(batches)
    r_mean, r_error, r_blocks, r_block_error = summary(reference_batches)
    z = (blocks - r_blocks) / np.maximum(np.hypot(block_error, r_block_error), 1e-12)
    return {
        "deviation": 100 * (mean / r_mean - 1),
        "error": 100 * float(np.hypot(error, r_error)) / r_mean,
        "rms_z": float(np.sqrt(np.mean(z ** 2))),
        "max_z": float(np.abs(z).max()),
        "block_deviation": 100 * float(np.sqrt(np.mean((blocks / r_blocks - 1) ** 2))),
    }
