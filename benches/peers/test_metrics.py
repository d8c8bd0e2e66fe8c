"""Tests of the metrics and of the meshes: `python3 -m unittest` in this folder."""

import math
import tempfile
import unittest
from pathlib import Path

import numpy as np

import meshes
import metrics
import scenes


class RelMse(unittest.TestCase):
    def setUp(self):
        self.reference = np.random.default_rng(1).uniform(0.1, 2, (30, 40, 3))

    def test_equal_images_have_no_error(self):
        self.assertEqual(metrics.rel_mse(self.reference, self.reference), 0)

    def test_value_of_a_flat_image(self):
        r = np.full((10, 10, 3), 2.0)
        self.assertAlmostEqual(metrics.rel_mse(1.1 * r, r), 0.01 / 1.01)

    def test_scale_does_not_matter(self):
        noisy = self.reference * np.random.default_rng(2).uniform(0.5, 1.5, self.reference.shape)
        self.assertAlmostEqual(metrics.rel_mse(noisy, self.reference), metrics.rel_mse(70 * noisy, 70 * self.reference))

    def test_black_pixels_are_finite(self):
        self.reference[0] = 0
        self.assertTrue(np.isfinite(metrics.rel_mse(self.reference + 1, self.reference)))

    def test_trimming_leaves_out_the_worst(self):
        image = self.reference.copy()
        image[3, 4] = 1e6
        self.assertGreater(metrics.rel_mse(image, self.reference), 1)
        self.assertEqual(metrics.rel_mse(image, self.reference, trim=0.001), 0)

    def test_error_falls_with_the_number_of_samples(self):
        noise = np.random.default_rng(3).normal(0, 0.3, (64,) + self.reference.shape)
        one = metrics.rel_mse(self.reference + noise[0], self.reference)
        many = metrics.rel_mse(self.reference + noise.mean(axis=0), self.reference)
        self.assertAlmostEqual(one / many / 64, 1, delta=0.2)


class Agreement(unittest.TestCase):
    def batches(self, seed, scale=1.0):
        return scale * np.random.default_rng(seed).exponential(1, (16, 300, 400, 3))

    def test_equal_means_agree(self):
        found = metrics.agreement(self.batches(1), self.batches(2))
        self.assertLess(abs(found["deviation"]), 4 * found["error"])
        self.assertLess(found["max_z"], 5)
        self.assertAlmostEqual(found["rms_z"], 1, delta=0.3)

    def test_a_percent_is_found(self):
        found = metrics.agreement(self.batches(1, 1.01), self.batches(2))
        self.assertAlmostEqual(found["deviation"], 1, delta=4 * found["error"])
        self.assertGreater(found["deviation"], 5 * found["error"])
        self.assertGreater(found["rms_z"], 2)


class Meshes(unittest.TestCase):
    def test_closed_meshes_are_wound_outwards(self):
        self.assertAlmostEqual(meshes.box(1, 2, 3).turned(1, 20).moved(4, 5, 6).volume(), 6, places=4)
        self.assertAlmostEqual(meshes.disc_slab(2, 1, 1.5).volume(), 2 * math.pi, delta=0.02)
        self.assertAlmostEqual(meshes.cup(2, 3, 1).volume(), math.pi * (12 - 2), delta=0.1)
        self.assertAlmostEqual(meshes.sphere(1, 4).volume(), 4 / 3 * math.pi, delta=0.02)

    def test_every_edge_of_the_sphere_is_shared_once_in_each_direction(self):
        faces = meshes.sphere(1, 3).faces
        self.assertEqual(len(faces), 1280)
        edges = {(a, b) for face in faces for a, b in zip(face, np.roll(face, -1))}
        self.assertEqual(len(edges), 3 * len(faces))
        self.assertTrue(all((b, a) in edges for a, b in edges))

    def test_lamps_face_where_they_should(self):
        for name, down in (("a", True), ("b", True), ("c", False), ("d", True)):
            lamp = next(part for part in scenes.scene(name).parts if part.emission)
            self.assertEqual(lamp.mesh.normal_of_first_face()[1] < 0, down, name)

    def test_walls_face_inwards(self):
        for part in scenes.room():
            to_centre = np.array([0, 1, 0]) - part.mesh.points[0]
            self.assertGreater(part.mesh.normal_of_first_face() @ to_centre, 0, part.name)

    def test_export_writes_every_format(self):
        with tempfile.TemporaryDirectory() as folder:
            scenes.export("d", folder)
            for file in ("caustica.xml", "mitsuba.xml", "luxcore.scn", "pane.obj", "pane.ply"):
                self.assertTrue((Path(folder) / file).stat().st_size > 0, file)


if __name__ == "__main__":
    unittest.main()
