"""Values that calls take and give: handles, vectors, structs and arrays of them."""
import collections
import functools

import numpy as np

from ._api import ffi
from ._library import ENUMS, EXPORTED, STRUCTS, camel, lib, tag

_NUMBERS = {"float": "f4", "double": "f8", "uint32_t": "u4", "int32_t": "i4", "uint64_t": "u8", "unsigned int": "u4"}


@functools.lru_cache(maxsize=None)
def _fields(c_name):
    return [(name, field.type, field.offset) for name, field in ffi.typeof(c_name).fields]


class Handle:
    """A value that names a thing in a world. False where it is null."""

    __slots__ = ("bits",)
    c_name = None

    def __init__(self, bits=0):
        self.bits = int(bits)

    def to_c(self):
        return ffi.new(self.c_name + "*", {"bits": self.bits})[0]

    def __bool__(self):
        return self.bits != 0

    def __eq__(self, other):
        return type(self) is type(other) and self.bits == other.bits

    def __hash__(self):
        return hash((self.c_name, self.bits))

    def __repr__(self):
        return f"{type(self).__name__}({self.bits:#x})"


def _is_handle(c_name):
    return [name for name, _, _ in _fields(c_name)] == ["bits"]


def _is_vector(c_name):
    kinds = {tag(kind) for _, kind, _ in _fields(c_name)}
    return kinds in ({"float"}, {"double"}) and all(len(name) <= 2 for name, _, _ in _fields(c_name))


HANDLES = {name: type(camel(name), (Handle,), {"__slots__": (), "c_name": name, "__module__": "taut"})
           for name in STRUCTS if _is_handle(name)}
VECTORS = {name: collections.namedtuple(camel(name), [field for field, _, _ in _fields(name)], module="taut")
           for name in STRUCTS if name not in HANDLES and _is_vector(name)}


def dtype_of(kind):
    """Of an array of a C type: vectors are rows of numbers, structs have fields of their names, handles are bits."""
    if kind.kind == "enum":
        return np.dtype("u4")
    if tag(kind) in HANDLES:
        return np.dtype("u8")
    if tag(kind) in VECTORS:
        (_, number, _), *_ = _fields(tag(kind))
        return np.dtype((_NUMBERS[tag(number)], (len(VECTORS[tag(kind)]._fields),)))
    if kind.kind == "array":
        return np.dtype((dtype_of(kind.item), (kind.length,)))
    if kind.kind == "struct":
        names, kinds, offsets = zip(*_fields(tag(kind)))
        return np.dtype({"names": names, "formats": [dtype_of(each) for each in kinds], "offsets": offsets,
                         "itemsize": ffi.sizeof(kind)})
    if kind.kind == "pointer":
        return np.dtype("u8")
    return np.dtype(_NUMBERS[tag(kind)])


def array_of(kind, pointer, count):
    """A copy, which outlives what it is of."""
    dtype = dtype_of(kind)
    if count == 0:
        return np.zeros((0, *dtype.shape), dtype.base)
    return np.frombuffer(ffi.buffer(pointer, count * ffi.sizeof(kind)), dtype, count).copy()


def to_array(kind, values):
    """(C array, what keeps it alive, number of entries) of numbers, vectors, handles or structs."""
    if tag(kind) in HANDLES:
        bits = [each.bits for each in values] if not isinstance(values, np.ndarray) else values
        whole = np.ascontiguousarray(bits, "u8")
    elif kind.kind == "struct" and tag(kind) not in VECTORS:
        entries = [STRUCT_CLASSES[tag(kind)].of(each) for each in values]
        block = ffi.new(f"{tag(kind)}[]", len(entries))
        for i, each in enumerate(entries):
            block[i] = each.to_c()[0]
        return block, (block, entries), len(entries)
    else:
        dtype = dtype_of(kind)
        whole = np.ascontiguousarray(values, dtype.base)
        if dtype.shape and (whole.ndim != 2 or whole.shape[1:] != dtype.shape):
            raise ValueError(f"rows of {dtype.shape[0]} numbers were expected, not an array of shape {whole.shape}")
    return ffi.cast(tag(kind) + "*", whole.ctypes.data), whole, len(whole)


def from_c(kind, value, owner=None):
    """A C value as Python's. Structs share memory with their owner."""
    if kind.kind == "enum":
        known = ENUMS[tag(kind)]
        return known(value) if value in known._value2member_map_ else value
    if tag(kind) in HANDLES:
        return HANDLES[tag(kind)](value.bits)
    if tag(kind) in VECTORS:
        vector = VECTORS[tag(kind)]
        return vector(*(getattr(value, name) for name in vector._fields))
    if kind.kind == "struct":
        return STRUCT_CLASSES[tag(kind)](_within=(ffi.addressof(value), owner))
    if kind.kind == "array":
        return [from_c(kind.item, each, owner) for each in value]
    return value


def to_c(kind, value):
    """A Python value as C takes it by value."""
    if tag(kind) in HANDLES:
        if value is None:
            value = HANDLES[tag(kind)]()
        if type(value) is not HANDLES[tag(kind)]:
            raise TypeError(f"a {camel(tag(kind))} was expected, not {value!r}")
        return value.to_c()
    if tag(kind) in VECTORS:
        numbers = [float(each) for each in value]
        if len(numbers) != len(VECTORS[tag(kind)]._fields):
            raise ValueError(f"{len(VECTORS[tag(kind)]._fields)} numbers were expected, not {len(numbers)}")
        return ffi.new(tag(kind) + "*", numbers)[0]
    if kind.kind == "struct":
        return STRUCT_CLASSES[tag(kind)].of(value).to_c()[0]
    if kind.kind == "enum":
        return int(value)
    if kind.kind == "pointer":
        return ffi.NULL if value is None else value
    return value


def _count_field(name, names):
    """Field with the number of entries of an array: point_count of points."""
    singular = [name, name[:-1], name[:-3] + "y", name[:-4] + "ex"]
    irregular = {"indices": "triangle_count", "sample_volumes": "sample_count"}
    candidates = [each + "_count" for each in singular] + [irregular.get(name)]
    return next((each for each in candidates if each in names), None)


class Struct:
    """A struct of the interface. As it is made it has the defaults that its _init function writes; fields may be given
    by name, those of its base as its own. Arrays are taken as numpy has them, and set their count. Of a struct within
    another it is a view."""

    c_name = None
    __slots__ = ("_pointer", "_owner", "_kept")

    def __init__(self, _within=None, **fields):
        hide = object.__setattr__
        hide(self, "_kept", {})
        if _within is not None:
            hide(self, "_pointer", _within[0])
            hide(self, "_owner", _within[1])
        else:
            hide(self, "_pointer", ffi.new(self.c_name + "*"))
            hide(self, "_owner", None)
            self._write_defaults()
        for name, value in fields.items():
            setattr(self, name, value)

    def _write_defaults(self):
        init = self.c_name + "_init"
        if init + "_sized" in EXPORTED:
            getattr(lib, init + "_sized")(self._pointer, ffi.sizeof(self.c_name))
            return
        if init in EXPORTED:
            getattr(lib, init)(self._pointer)
            return
        for name, kind, _ in _fields(self.c_name):
            if name == "struct_size":
                self._pointer.struct_size = ffi.sizeof(self.c_name)
            elif tag(kind) == "taut_quat":
                getattr(self._pointer, name).w = 1
        if self.c_name in _DEFAULTS_WITHIN:
            owner, name = _DEFAULTS_WITHIN[self.c_name]
            whole = STRUCT_CLASSES[owner]().to_c()
            value = getattr(whole, name)
            self._pointer[0] = value[0] if ffi.typeof(value).kind == "array" else value

    @classmethod
    def of(cls, value):
        """A struct of this kind, or of a dict of its fields."""
        if isinstance(value, cls):
            return value
        if isinstance(value, dict):
            return cls(**value)
        raise TypeError(f"a {cls.__name__} was expected, not {value!r}")

    def to_c(self):
        return self._pointer

    def _kind(self, name):
        for each, kind, _ in _fields(self.c_name):
            if each == name:
                return kind
        raise AttributeError(f"{type(self).__name__} has no field '{name}'")

    def _is_of_base(self, name):
        return name not in dir(self) and "base" in dir(self) and name in dir(self.base)

    def __getattr__(self, name):
        if self._is_of_base(name):
            return getattr(self.base, name)
        kind = self._kind(name)
        value = getattr(self._pointer, name)
        if kind.kind != "pointer":
            return from_c(kind, value, self)
        if name in self._kept:
            return self._kept[name][0]
        count = _count_field(name, dir(self))
        if count and kind.item.kind != "function":
            return array_of(kind.item, value, getattr(self._pointer, count))
        return value

    def __setattr__(self, name, value):
        if self._is_of_base(name):
            setattr(self.base, name, value)
            return
        kind = self._kind(name)
        if kind.kind == "pointer" and not isinstance(value, ffi.CData) and value is not None:
            pointer, alive, count = to_array(kind.item, value)
            setattr(self._pointer, name, pointer)
            self._kept[name] = (value, alive)
            field = _count_field(name, dir(self))
            if field and name != "rest":
                setattr(self._pointer, field, count)
            if name == "cells" and "corners" in dir(self):
                self._pointer.corners = np.shape(value)[1]
            return
        if kind.kind == "array":
            target = getattr(self._pointer, name)
            values = list(value)
            if len(values) > kind.length:
                raise ValueError(f"{name} has {kind.length} entries, not {len(values)}")
            for i, each in enumerate(values):
                target[i] = to_c(kind.item, each)
            self._kept[name] = (values, values)
            return
        setattr(self._pointer, name, to_c(kind, value))
        self._kept[name] = (value, value)

    def __dir__(self):
        return [name for name, _, _ in _fields(self.c_name)]

    def __repr__(self):
        fields = (f"{name}={getattr(self, name)!r}" for name in dir(self) if name not in ("struct_size", "reserved"))
        return f"{type(self).__name__}({', '.join(fields)})"


STRUCT_CLASSES = {name: type(camel(name), (Struct,), {"__slots__": (), "c_name": name, "__module__": "taut"})
                  for name in STRUCTS if name not in HANDLES and name not in VECTORS}


def _defaults_within():
    """Structs without an _init of their own: the def, and its field, whose _init writes the defaults of one."""
    found = {}
    for owner in STRUCT_CLASSES:
        if owner + "_init_sized" not in EXPORTED:
            continue
        for name, kind, _ in _fields(owner):
            item = kind.item if kind.kind == "array" else kind
            if tag(item) in STRUCT_CLASSES and tag(item) + "_init_sized" not in EXPORTED:
                found.setdefault(tag(item), (owner, name))
    return found


_DEFAULTS_WITHIN = _defaults_within()
