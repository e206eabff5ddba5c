"""Taut for Python: the C interface, in Python's words.

    import taut

    with taut.World(gravity=(0, -9.81, 0)) as world:
        box = world.add_box(half_extents=(0.5, 0.5, 0.5))
        crate = world.add_body(shape=box, position=(0, 3, 0))
        world.step()
        print(crate.get_pose().position)

Handles have the functions that take them first: taut_body_get_pose is Body.get_pose. Defs are objects with their
defaults (BodyDef()), or the names of their fields. What C writes through pointers is returned, arrays as numpy's. A
refused call raises the error of its result, with the library's text. Bodies reads many bodies at once."""
from . import _calls
from ._api import ffi
from ._headers import CONSTANTS, DOCS, VERSION as __version__
from ._library import ENUMS, ERRORS, Error, check, lib
from ._values import HANDLES, STRUCT_CLASSES, VECTORS, Handle, Struct
from .bodies import Bodies

globals().update({kind.__name__: kind for kind in
                  (*ENUMS.values(), *HANDLES.values(), *VECTORS.values(), *STRUCT_CLASSES.values(), *ERRORS.values())})
globals().update(CONSTANTS)
_calls.attach(globals())


def _create(self, *given, **fields):
    """A new world of a WorldDef or of its fields; of bits, a handle of one that is there."""
    if given and isinstance(given[0], int):
        Handle.__init__(self, *given)
    else:
        Handle.__init__(self, world_create(*given, **fields).bits)  # noqa: F821


def _leave(self, *_):
    if self.is_valid():
        self.destroy()


def _get_body_states(self, bodies):
    """Bodies of the world, read: poses and velocities as numpy arrays."""
    return Bodies(self, bodies).read()


def _save(self):
    """A snapshot, for restore()."""
    size, written = self.snapshot_size(), ffi.new("uint64_t*")
    block = bytearray(size)
    check(lib.taut_world_save(self.to_c(), ffi.from_buffer(block), size, written))
    return bytes(block)


def _restore(self, snapshot):
    check(lib.taut_world_restore(self.to_c(), ffi.from_buffer(snapshot), len(snapshot)))


_restore.__doc__ = DOCS["taut_world_restore"]
World = HANDLES["taut_world"]
World.__init__, World.__enter__, World.__exit__ = _create, lambda self: self, _leave
World.get_body_states, World.save, World.restore = _get_body_states, _save, _restore
