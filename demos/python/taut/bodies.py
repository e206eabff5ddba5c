"""Many bodies at once."""
import numpy as np

from ._api import ffi
from ._library import check, lib
from ._values import dtype_of


class Bodies:
    """Poses and velocities of bodies of one world, in arrays that stay where they are: read() fills them anew.

    position [N, 3] doubles, rotation [N, 4] (x, y, z, w), linear and angular [N, 3] velocities; the first two are views
    of poses, as C has them."""

    def __init__(self, world, bodies):
        self.world = world
        self.handles = np.array([body.bits for body in bodies], "u8")
        self.poses = np.zeros(len(self.handles), dtype_of(ffi.typeof("taut_pose")))
        self.position, self.rotation = self.poses["position"], self.poses["rotation"]
        self.linear = np.zeros((len(self.handles), 3), "f4")
        self.angular = np.zeros((len(self.handles), 3), "f4")

    def __len__(self):
        return len(self.handles)

    def read(self):
        """Returns itself, as of the last step."""
        at = [ffi.cast(kind, array.ctypes.data)
              for kind, array in (("taut_body*", self.handles), ("taut_pose*", self.poses),
                                  ("taut_vec3*", self.linear), ("taut_vec3*", self.angular))]
        check(lib.taut_world_get_body_states(self.world.to_c(), at[0], len(self), at[1], 0, at[2], 0, at[3], 0))
        return self
