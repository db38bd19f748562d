# SPDX-License-Identifier: BSD-3-Clause
import os
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy as np

import photonav

SOURCE = pathlib.Path(os.environ["PHOTONAV_SOURCE_DIR"])
TWO_TEXTURES = SOURCE / "config" / "two_textures.yaml"
SCENE = SOURCE / "config" / "scenes" / "two_textures.yaml"
QUICK = ["planner.vertices=200", "planner.view_pitch=0.5"]


class Geometry(unittest.TestCase):
    def test_twists_and_motions_are_inverse(self):
        xi = np.array([0.3, -0.2, 0.1, 0.4, -0.5, 0.6])
        T = photonav.exp_se3(xi)
        self.assertEqual(T.shape, (4, 4))
        np.testing.assert_allclose(photonav.log_se3(T), xi, atol=1e-12)
        eta = np.array([0.1, 0.2, 0.3, 0.0, 0.1, 0.0])
        np.testing.assert_allclose(
            T @ photonav.exp_se3(eta) @ np.linalg.inv(T), photonav.exp_se3(photonav.adjoint(T) @ eta), atol=1e-12
        )

    def test_update_is_that_of_information_filters(self):
        A = np.random.default_rng(1).normal(size=(6, 6))
        covariance, information = A @ A.T, 4 * np.eye(6)
        expected = np.linalg.inv(information + np.linalg.inv(covariance))
        np.testing.assert_allclose(photonav.update(covariance, information), expected, atol=1e-9)
        np.testing.assert_array_equal(photonav.update(np.zeros((6, 6)), information), np.zeros((6, 6)))

    def test_compounding_adds_covariances_of_pure_translations(self):
        T = np.eye(4)
        T[:3, 3] = 1, 2, 3
        mean, covariance = photonav.compound(T, 1e-6 * np.eye(6), T, np.zeros((6, 6)))
        np.testing.assert_allclose(mean[:3, 3], (2, 4, 6))
        np.testing.assert_allclose(covariance, 1e-6 * np.eye(6), atol=1e-10)

    def test_bad_arrays_are_value_errors(self):
        for bad in (np.eye(3), 2 * np.eye(4), np.full((4, 4), np.nan), np.diag([1, 1, -1, 1])):
            with self.assertRaises(ValueError):
                photonav.log_se3(bad)
        with self.assertRaisesRegex(ValueError, "covariance: not positive semi-definite"):
            photonav.update(-np.eye(6), np.eye(6))
        with self.assertRaisesRegex(ValueError, "mount"):
            photonav.camera_pose((0, 0, 0), mount="sideways")


class ViewsAndMaps(unittest.TestCase):
    def setUp(self):
        self.camera = photonav.Camera()
        self.views = photonav.Views.load(SCENE)
        self.above_texture = photonav.camera_pose((7, 4, 2))

    def test_a_level_floor_is_seen_at_its_depth(self):
        image, depth = self.views.render(self.camera, self.above_texture)
        self.assertEqual(image.shape, (120, 188))
        self.assertEqual(image.dtype, np.float32)
        np.testing.assert_allclose(depth, 2, atol=1e-4)
        self.assertGreater(image.std(), 0.05)
        self.assertEqual(self.views.cell_size, 0)

    def test_information_is_that_of_the_gradients(self):
        image, depth = self.views.render(self.camera, self.above_texture)
        information = photonav.information(image, depth, self.camera, sigma=0.02)
        np.testing.assert_allclose(information, information.T)
        # J of a translation along x at constant depth: the gradient times -fx / z
        gradient = 0.5 * (image[1:-1, 2:] - image[1:-1, :-2])
        expected = 0.08 * np.sum((gradient * self.camera.fx / 2) ** 2) / 0.02**2
        self.assertAlmostEqual(information[0, 0] / expected, 1, delta=0.01)
        share = photonav.contribution(image, depth, self.camera, (1, 0, 0, 0, 0, 0))
        self.assertAlmostEqual(share.sum() / information[0, 0], 1, delta=1e-4)
        white = photonav.information(np.full_like(image, 0.9), depth, self.camera)
        np.testing.assert_array_equal(white, np.zeros((6, 6)))

    def test_images_fused_into_a_map_are_seen_again(self):
        map_ = photonav.Map(0.05)
        image, depth = self.views.render(self.camera, self.above_texture)
        self.assertGreater(map_.fuse(image, depth, self.camera, self.above_texture), 100)
        centres, greys = map_.occupied()
        self.assertEqual(centres.shape, (len(greys), 3))
        self.assertLess(np.abs(centres[:, 2]).max(), 0.06)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "map.ot"
            map_.save(file)
            seen, seen_depth = photonav.Views.load(file).render(self.camera, self.above_texture)
            self.assertEqual(photonav.Map.load(file).resolution, 0.05)
        valid = seen_depth > 0
        self.assertGreater(valid.mean(), 0.9)
        self.assertLess(np.abs(seen - image)[valid].mean(), 0.05)

    def test_bytes_are_scaled_and_other_ranges_refused(self):
        image, depth = self.views.render(self.camera, self.above_texture)
        grey = np.round(255 * image)
        information = photonav.information(grey.astype(np.uint8), depth, self.camera)
        np.testing.assert_allclose(information, photonav.information(grey / 255, depth, self.camera), rtol=1e-4)
        self.assertGreater(information[0, 0], 1)
        map_ = photonav.Map(0.05)
        map_.fuse(grey.astype(np.uint8), depth, self.camera, self.above_texture)
        self.assertLessEqual(np.nanmax(map_.occupied()[1]), 1)
        for call in (
            lambda image, depth: photonav.information(image, depth, self.camera),
            lambda image, depth: photonav.contribution(image, depth, self.camera),
            lambda image, depth: map_.fuse(image, depth, self.camera, self.above_texture),
        ):
            with self.assertRaisesRegex(ValueError, r"image: expected grey values in \[0, 1\], found .* to 2"):
                call(grey, depth)
            with self.assertRaisesRegex(ValueError, "image: not finite"):
                call(np.full_like(image, np.nan), depth)
            with self.assertRaisesRegex(ValueError, "depth: not finite"):
                call(image, np.full_like(depth, np.nan))
        noisy = image + 0.02 * np.random.default_rng(1).normal(size=image.shape)
        photonav.information(noisy, depth, self.camera)

    def test_errors_name_file_and_argument(self):
        with self.assertRaisesRegex(photonav.InputError, "none.ot"):
            photonav.Views.load("/no/such/none.ot")
        self.assertTrue(issubclass(photonav.InputError, ValueError))
        with self.assertRaisesRegex(ValueError, r"depth: expected the camera's shape \(120, 188\)"):
            photonav.information(np.zeros((120, 188)), np.zeros((2, 2)), self.camera)


class Documentation(unittest.TestCase):
    def test_all_that_is_public_has_a_docstring(self):
        classes = [photonav.Camera, photonav.Views, photonav.Map, photonav.Path, photonav.Plan, photonav.Problem]
        public = [getattr(photonav, name) for name in dir(photonav) if not name.startswith("_")]
        for owner in classes:
            public += [getattr(owner, name) for name in dir(owner) if not name.startswith("_")]
        for each in public:
            if callable(each) or isinstance(each, property):
                lines = [line for line in (each.__doc__ or "").splitlines() if " -> " not in line]
                self.assertTrue("".join(lines).strip(), each)

    def test_objects_say_what_they_are(self):
        self.assertEqual(repr(photonav.Camera(64, 48, 90)), "<Camera 64x48, fx 32.0, fy 32.0, cx 31.5, cy 23.5>")
        plan = photonav.Problem(TWO_TEXTURES, QUICK).plan()
        self.assertRegex(repr(plan.path), r"<Path of belief_rrt_star: \d+ points, \d+\.\d\d m, cost .*>")
        self.assertRegex(repr(plan), r"<Plan: done, 200 vertices, .* s, path <Path of .*>>")


class Planning(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.problem = photonav.Problem(TWO_TEXTURES, QUICK)

    def test_beliefs_along_a_path(self):
        path = self.problem.beliefs([[0, 0, 2], [6, 4, 2], [2, 9, 2]])
        self.assertEqual(path.positions.shape[1:], (3,))
        n = len(path.positions)
        self.assertEqual(path.T_w_b.shape, (n, 4, 4))
        self.assertEqual(path.covariance.shape, (n, 6, 6))
        np.testing.assert_allclose(path.trace, np.trace(path.covariance, axis1=1, axis2=2))
        np.testing.assert_allclose(path.positions[path.is_waypoint], [[0, 0, 2], [6, 4, 2], [2, 9, 2]])
        self.assertAlmostEqual(path.length, np.hypot(6, 4) + np.hypot(4, 5))
        self.assertLess(path.position_sigma[-1], path.position_sigma[0])
        np.testing.assert_allclose(path.yaw, np.pi / 2)

    def test_plans_are_those_of_their_seed(self):
        calls = []
        plan = self.problem.plan(seed=3, on_progress=lambda vertices, cost: calls.append(vertices))
        self.assertEqual(plan.status, "done")
        self.assertEqual(plan.vertices, 200)
        self.assertEqual(calls[-1], 200)
        again = self.problem.plan(seed=3)
        np.testing.assert_array_equal(plan.path.positions, again.path.positions)
        shortest = self.problem.plan("rrt_star")
        self.assertLess(plan.path.cost, shortest.path.cost)
        self.assertLess(shortest.path.length, plan.path.length)
        self.assertEqual(plan.tree.shape[1:], (2, 3))
        with self.assertRaisesRegex(ValueError, "no planner is named prm"):
            self.problem.plan("prm")

    def test_a_config_may_be_a_dictionary(self):
        config = {
            "scene": {"file": str(SCENE)},
            "bounds": [[-1, -0.5, 2], [9, 9.5, 2]],
            "start": [0, 0, 2, np.pi / 2],
            "goal": [2, 9, 2],
            "space": "xyz",
            "planner": {"alpha": 0.5, "vertices": 100, "view_pitch": 0.5},
        }
        problem = photonav.Problem(config, ["seed=5"])
        self.assertIn("seed: 5", problem.config)
        shortest = problem.plan("rrt_star").path  # kappa is automatic
        self.assertAlmostEqual(shortest.length_share, 0.5)
        config["planner"]["alhpa"] = 1
        with self.assertRaisesRegex(photonav.InputError, "config: planner.alhpa: .*'planner.alpha'"):
            photonav.Problem(config)

    def test_flights_arrive(self):
        plan = self.problem.plan()
        done = []
        result = self.problem.fly(plan, flights=2, on_flight=done.append)
        self.assertEqual(done, [1, 2])
        self.assertEqual(result["arrived"], 2)
        flight = result["flights"][0]
        self.assertEqual(flight["end"], "arrived")
        error = np.linalg.norm(flight["true_position"] - flight["believed_position"], axis=1)
        self.assertEqual(error.shape, flight["time"].shape)
        self.assertLess(error[-1], 0.3)

    def test_places_in_collision_are_input_errors(self):
        problem = photonav.Problem(SOURCE / "config" / "room.yaml", ["goal=[0.3, 3, 1]"])
        self.assertLess(problem.clearance((0.3, 3, 1)), 0.25)
        with self.assertRaisesRegex(photonav.InputError, "goal: in collision"):
            problem.plan()


class LongCalls(unittest.TestCase):
    def test_other_threads_go_on(self):
        problem = photonav.Problem(TWO_TEXTURES, ["planner.vertices=1500"])
        ticks = []
        stop = threading.Event()

        def tick():
            while not stop.wait(0.01):
                ticks.append(time.monotonic())

        thread = threading.Thread(target=tick)
        thread.start()
        problem.plan()
        stop.set()
        thread.join()
        self.assertGreater(len(ticks), 5)

    def test_ctrl_c_ends_them(self):
        problem = photonav.Problem(TWO_TEXTURES, ["planner.vertices=100000000"])
        interrupt = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
        interrupt.start()
        with self.assertRaises(KeyboardInterrupt):
            problem.plan()


class Replay(unittest.TestCase):
    def test_a_recording_is_tracked(self):
        result = photonav.replay(SOURCE / "data" / "flight_down", odometry=True, frames="0:10")
        self.assertEqual(result["tracked"], len(result["time"]))
        self.assertEqual(result["T_c_w"].shape, (len(result["time"]), 4, 4))
        self.assertLess(result["ate_rmse_m"], 0.1)
        with self.assertRaisesRegex(photonav.InputError, "no such option, did you mean 'odometry'"):
            photonav.replay(SOURCE / "data" / "flight_down", odometri=True)
        with self.assertRaisesRegex(photonav.InputError, "^replay: map: needed, or odometry: nothing to find"):
            photonav.replay(SOURCE / "data" / "flight_down")


if __name__ == "__main__":
    unittest.main()
