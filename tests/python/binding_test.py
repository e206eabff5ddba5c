"""The Python binding as it was installed. PILE: pile.c compiled. CC: a C compiler, INCLUDE: the headers."""
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import taut
from taut import _calls, _headers
from taut._api import ffi


def period_of_pendulum(amplitude, inertia, arm, gravity=9.81):
    """By the complete elliptic integral, through the arithmetic-geometric mean [s]; mass 1."""
    a, b = 1.0, math.cos(amplitude / 2)
    while abs(a - b) > 1e-15:
        a, b = (a + b) / 2, math.sqrt(a * b)
    return 2 * math.pi * math.sqrt(inertia / (gravity * arm)) / a


class Pendulum(unittest.TestCase):
    def swing(self, amplitude):
        """Time between the first and the sixth passage through the vertical in one direction, over five [s]."""
        arm, own = 1.0, 0.02
        with taut.World(substeps=16) as world:
            bob = world.add_body(mass=1, inertia=(own, own, own, 0, 0, 0), position=(0, -arm, 0))
            a, b = taut.joint_frames_from_world(world, taut.Body(), bob, (0, 0, 0), (0, 0, 1))
            hinge = world.add_hinge_joint(body_b=bob, frame_a=a, frame_b=b)
            bob.set_pose({"position": (arm * math.sin(amplitude), -arm * math.cos(amplitude), 0),
                          "rotation": (0, 0, math.sin(amplitude / 2), math.cos(amplitude / 2))})
            passages, before, time = [], None, 0.0
            while len(passages) < 6:
                world.step()
                time += 1 / 60
                angle, rate = hinge.get_coordinates(0)
                if before is not None and before > 0 >= angle:
                    passages.append(time - angle / rate)
                before = angle
                self.assertLess(time, 60)
            self.assertLess(hinge.get_error(), 1e-4)
        return (passages[-1] - passages[0]) / 5, period_of_pendulum(amplitude, own + arm * arm, arm)

    def test_period_matches_the_elliptic_integral(self):
        for degrees, bound in ((20, 2e-4), (120, 2e-4)):
            measured, expected = self.swing(math.radians(degrees))
            print(f"{degrees} degrees: {measured:.5f} s, by the elliptic integral {expected:.5f} s")
            self.assertLess(abs(measured / expected - 1), bound, f"{degrees} degrees")


class Refused(unittest.TestCase):
    def setUp(self):
        self.world = taut.World()
        self.addCleanup(lambda: self.world.is_valid() and self.world.destroy())

    def test_what_the_library_refuses_raises_its_text(self):
        with self.assertRaises(taut.InvalidArgument) as caught:
            self.world.add_sphere(radius=math.nan)
        self.assertIsInstance(caught.exception, (taut.Error, ValueError))
        self.assertEqual(caught.exception.result, taut.Result.INVALID_ARGUMENT)
        self.assertRegex(str(caught.exception), "taut_world_add_sphere: radius is nan")
        self.assertEqual(self.world.get_counts(), (0, 0, 0))

    def test_each_result_has_its_error(self):
        sphere = self.world.add_sphere()
        body = self.world.add_body(shape=sphere)
        with self.assertRaises(taut.InUse):
            sphere.remove()
        with taut.World() as other, self.assertRaises(taut.ForeignHandle):
            other.add_body(shape=sphere)
        body.remove()
        with self.assertRaises(taut.StaleHandle):
            body.get_pose()
        definition = taut.BodyDef(shape=sphere)
        definition.struct_size = 0
        with self.assertRaises(taut.StructSize):
            self.world.add_body(definition)
        self.world.destroy()
        with self.assertRaises(taut.StaleHandle):
            self.world.step()

    def test_what_python_can_tell_is_refused_before(self):
        with self.assertRaises(AttributeError):
            self.world.add_sphere(radios=1)
        with self.assertRaises(TypeError):
            self.world.add_body(shape=self.world)
        with self.assertRaises(ValueError):
            self.world.add_body(position=(1, 2))
        with self.assertRaises(ValueError):
            self.world.add_hull(points=np.zeros((4, 2)))
        with self.assertRaises(TypeError):
            self.world.set_gravity()


def add_pile(world):
    """As pile.c."""
    ground = world.add_plane()
    shapes = world.add_box(half_extents=(0.25, 0.125, 0.25)), world.add_sphere(radius=0.25)
    world.add_body(kind=taut.BodyKind.STATIC, shape=ground)
    bodies = []
    for i in range(200):
        definition = taut.BodyDef(shape=shapes[i % 2])
        definition.position = 0.625 * (i % 5) + 0.03125 * (i % 3), 0.5 + 0.625 * (i // 25), 0.625 * (i // 5 % 5)
        definition.material.friction = 0.75
        bodies.append(world.add_body(definition))
    world.add_ball_joint(body_b=bodies[-1], frame_a={"position": (2.5, 6, 2.5)}, frame_b={"position": (0, 1, 0)})
    return bodies


class JointBase(unittest.TestCase):
    def test_its_fields_are_those_of_every_def(self):
        with taut.World() as world:
            bob = world.add_body(mass=1, inertia=(1, 1, 1, 0, 0, 0), position=(1, 2, 3))
            base = taut.JointBase(body_b=bob, user_data=7, frame_a={"position": (1, 2, 3)})
            self.assertEqual((base.solve, base.frame_b.rotation.w), (taut.JointSolve.BY_LOAD, 1))
            kinds = {"Ball": world.add_ball_joint, "Hinge": world.add_hinge_joint, "SixDof": world.add_six_dof_joint}
            for kind, add in kinds.items():
                whole = getattr(taut, kind + "JointDef")(base=base)
                by_name = getattr(taut, kind + "JointDef")(body_b=bob, user_data=7)
                by_name.frame_a.position = 1, 2, 3
                self.assertEqual((by_name.body_b, by_name.base.user_data), (bob, 7))
                for joint in add(whole), add(by_name), add(base=base):
                    self.assertEqual(joint.get_bodies(), (taut.Body(), bob))
                    self.assertEqual(joint.get_user_data(), 7)
                    self.assertEqual(joint.get_frames()[0].position, (1, 2, 3))
            with self.assertRaises(taut.InvalidArgument) as caught:
                world.add_ball_joint(body_b=bob, break_torque=2)
            self.assertIn("base.break_torque is 2, expected 0", str(caught.exception))
            with self.assertRaises(AttributeError) as caught:
                taut.HingeJointDef(boddy_b=bob)
            self.assertIn("HingeJointDef has no field 'boddy_b'", str(caught.exception))


class Pile(unittest.TestCase):
    def test_bulk_poses_are_an_array_that_stays(self):
        with taut.World() as world:
            bodies = add_pile(world)
            states = world.get_body_states(bodies)
            self.assertEqual((states.position.shape, states.position.dtype), ((200, 3), np.float64))
            self.assertEqual((states.rotation.shape, states.rotation.dtype), ((200, 4), np.float32))
            self.assertTrue(np.shares_memory(states.position, states.poses))
            began, place = states.position.copy(), states.position.ctypes.data
            for _ in range(240):
                world.step()
            self.assertTrue((states.position == began).all())
            states.read()
            self.assertEqual(states.position.ctypes.data, place)
            self.assertLess(states.position[:, 1].mean(), began[:, 1].mean() - 0.5)
            self.assertGreater(states.position[:, 1].min(), 0.1)
            np.testing.assert_allclose(np.linalg.norm(states.rotation, axis=1), 1, atol=1e-5)
            for i in (0, 77, 199):
                pose, (linear, angular) = bodies[i].get_pose(), bodies[i].get_velocity()
                self.assertEqual(tuple(states.position[i]), pose.position)
                self.assertEqual(tuple(states.rotation[i]), pose.rotation)
                self.assertEqual((tuple(states.linear[i]), tuple(states.angular[i])), (linear, angular))

    def test_state_is_that_of_the_c_program(self):
        with taut.World() as world:
            add_pile(world)
            for _ in range(240):
                world.step()
            state = f"{world.get_state_hash():016x}"
        self.assertEqual(state, subprocess.run(os.environ["PILE"], capture_output=True, text=True, check=True)
                         .stdout.strip())

    def test_a_snapshot_brings_the_state_back(self):
        with taut.World() as world:
            add_pile(world)
            for _ in range(30):
                world.step()
            snapshot, state = world.save(), world.get_state_hash()
            world.step()
            self.assertNotEqual(world.get_state_hash(), state)
            world.restore(snapshot)
            self.assertEqual(world.get_state_hash(), state)
            with self.assertRaises(taut.InvalidArgument):
                world.restore(snapshot[:-1])


class Interface(unittest.TestCase):
    def test_every_function_has_its_place(self):
        places = {function.name for function in vars(taut).values() if isinstance(function, _calls.Function)}
        methods = {f"{kind.c_name}_{name}" for kind in (*taut.HANDLES.values(), *taut.STRUCT_CLASSES.values())
                   for name in vars(kind)}
        names = {name.removesuffix("_sized") for name in _headers.FUNCTIONS}
        names = {name for name in names if not name.endswith("_init")}
        self.assertGreater(len(names), 200)
        self.assertEqual(names - places - methods, set())

    def test_structs_lie_as_the_compiler_lays_them(self):
        lines, expected = [], []
        for name in taut.STRUCT_CLASSES | taut.VECTORS | taut.HANDLES:
            lines.append(f"sizeof({name})")
            expected.append(ffi.sizeof(name))
            for field, _ in ffi.typeof(name).fields:
                lines.append(f"offsetof({name}, {field})")
                expected.append(ffi.offsetof(name, field))
        self.assertGreater(len(lines), 600)
        with tempfile.TemporaryDirectory() as folder:
            source, program = Path(folder) / "layout.c", Path(folder) / "layout"
            source.write_text("#include <stddef.h>\n#include <stdio.h>\n#include <taut/taut.h>\nint main(void) {\n" +
                              "".join(f'printf("%zu\\n", {line});\n' for line in lines) + "return 0;\n}\n")
            subprocess.run([os.environ["CC"], "-std=c11", f"-I{os.environ['INCLUDE']}", source, "-o", program],
                           check=True)
            found = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
        for line, mine, compilers in zip(lines, expected, found, strict=True):
            self.assertEqual(mine, int(compilers), line)

    def test_defs_have_the_library_s_defaults(self):
        definition = taut.BodyDef()
        self.assertEqual((definition.density, definition.kind, definition.rotation.w),
                         (1000, taut.BodyKind.DYNAMIC, 1))
        self.assertEqual(taut.Material().friction, 0.5)
        self.assertEqual(taut.Filter().mask, 2**64 - 1)
        self.assertEqual(taut.Drive().max_force, math.inf)
        self.assertEqual(taut.ClothDef().set_fabric(taut.Fabric.DENIM).area_density, np.float32(0.4))

    def test_arrays_go_in_and_come_out(self):
        side = 5
        points = np.array([(x, 2, z) for z in range(side) for x in range(side)], float)
        triangles = np.array([corner for z in range(side - 1) for x in range(side - 1)
                              for corner in ((z * side + x, (z + 1) * side + x, z * side + x + 1),
                                             (z * side + x + 1, (z + 1) * side + x, (z + 1) * side + x + 1))])
        with taut.World() as world:
            cloth = world.add_cloth(points=points, triangles=triangles)
            for corner in (0, side - 1):
                cloth.pin(corner, 1)
            np.testing.assert_array_equal(cloth.get_triangles(), triangles)
            self.assertEqual(len(cloth.get_bodies()), side * side)
            for _ in range(30):
                world.step()
            now = cloth.get_points()
            self.assertEqual((now.shape, now.dtype), ((side * side, 3), np.float64))
            np.testing.assert_array_equal(now[[0, side - 1]], points[[0, side - 1]])
            self.assertLess(now[-1, 1], 1.5)

    def test_events_and_queries_are_arrays_of_records(self):
        with taut.World(contact_events=taut.CONTACT_EVENTS_ALL) as world:
            ground = world.add_body(kind=taut.BodyKind.STATIC, shape=world.add_plane())
            ball = world.add_body(shape=world.add_sphere(), position=(0, 1, 0), user_data=7)
            hits = []
            for _ in range(60):
                world.step()
                events = world.get_events()
                hits += list(events.hit)
            self.assertEqual([(taut.Body(hit["body_a"]), taut.Body(hit["body_b"])) for hit in hits], [(ground, ball)])
            self.assertAlmostEqual(hits[0]["approach_speed"], math.sqrt(2 * 9.81 * 0.5), delta=0.1)
            self.assertEqual(events.moved["user_data"].tolist(), [7])
            rays = [taut.Ray(origin=(0, 5, 0), translation=(0, -10, 0)),
                    taut.Ray(origin=(2, 5, 0), translation=(0, -10, 0))]
            found = world.cast_rays(rays, filter=taut.QueryFilter())
            self.assertEqual([taut.Body(each) for each in found["body"]], [ball, ground])
            np.testing.assert_allclose(found["point"][1], (2, 0, 0), atol=1e-6)
            self.assertEqual(world.cast_ray(rays[0]).body, ball)


if __name__ == "__main__":
    unittest.main(verbosity=2)
