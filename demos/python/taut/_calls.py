"""Functions of the interface as methods of handles, by rules on their parameters.

Results that are not TAUT_OK are raised. What a function writes through its last pointers is returned: one value, a
tuple of several, or an array where the caller of C gives capacity and count. Defs are given as objects or by the names
of their fields."""
import numpy as np

from ._api import ffi
from ._headers import DOCS, FUNCTIONS, SIZED
from ._library import STRUCTS, check, lib, tag
from ._values import HANDLES, STRUCT_CLASSES, array_of, dtype_of, from_c, to_array, to_c

# Numbers an entry of what is counted in more than one.
_ROWS = {"taut_cloth_get_triangles": 3, "taut_solid_get_triangles": 3}
# Written by hand, in __init__.py.
BY_HAND = {"taut_world_get_body_states", "taut_world_save", "taut_world_restore"}


def _bare(c_type):
    return c_type.replace("const ", "").rstrip("*")


class _Given:
    """A parameter of the Python function."""

    def __init__(self, c_type, name, optional=False):
        self.c_type, self.name, self.optional = c_type, name, optional


class Function:
    """A function of the interface, called as Python calls."""

    def __init__(self, name, result, parameters):
        self.name, self.result = name, result
        exported, sized = SIZED.get(name, (name, None))
        self.call = getattr(lib, exported)
        self.given, self.plan = [], []
        names = [each for _, each in parameters]
        i = 0
        while i < len(parameters):
            c_type, each = parameters[i]
            following = names[i + 1:i + 3]
            if name in SIZED and i == len(parameters) - 1:
                self.plan.append(("size", parameters[names.index(sized)][0]))
            elif not c_type.endswith("*"):
                optional = c_type.endswith("_fn")
                self._take("value", c_type, each, optional)
            elif c_type == "void*":
                self._take("value", c_type, each, True)
            elif c_type.startswith("const "):
                if following[:1] == ["count"]:
                    self._take("array", c_type, each)
                    i += 1
                elif _bare(c_type) not in STRUCTS:
                    self._take("numbers", c_type, each)
                else:
                    self._take("struct", c_type, each, each in ("filter", "allocator"))
            elif following == ["capacity", "count"]:
                self.plan.append(("many", c_type))
                i += 2
            elif any(kind == "array" for kind, *_ in self.plan):
                self.plan.append(("as many", c_type))
            else:
                self.plan.append(("one", c_type))
            i += 1
        self.takes_def = next((p for p in self.given if p.name == "def"), None)

    def _take(self, how, c_type, name, optional=False):
        self.given.append(_Given(c_type, name, optional))
        self.plan.append((how, c_type, len(self.given) - 1))

    def _arguments(self, values, fields):
        """In the order of what is given, defs made of fields."""
        values = list(values)
        if self.takes_def:
            at = self.given.index(self.takes_def)
            others = {p.name for p in self.given if p is not self.takes_def}
            own = {name: fields.pop(name) for name in list(fields) if name not in others}
            kind = STRUCT_CLASSES[_bare(self.takes_def.c_type)]
            if len(values) <= at:
                values.append(kind(**own))
            elif own:
                raise TypeError(f"{self.name} takes a def or its fields, not both")
        for parameter in self.given[len(values):]:
            if parameter.name in fields:
                values.append(fields.pop(parameter.name))
            elif parameter.optional:
                values.append(None)
            else:
                raise TypeError(f"{self.name} needs {parameter.name}")
        if fields or len(values) > len(self.given):
            raise TypeError(f"{self.name} takes {', '.join(p.name for p in self.given)}, not "
                            f"{', '.join(fields) or 'so many'}")
        return values

    def __call__(self, *values, **fields):
        values = self._arguments(values, dict(fields))
        alive, arguments, outputs, count = [], [], [], 0
        for how, c_type, *at in self.plan:
            value = values[at[0]] if at else None
            kind = ffi.typeof(_bare(c_type)) if _bare(c_type) != "void" else None
            if how == "value":
                arguments.append(ffi.NULL if value is None and kind is None else
                                 to_c(ffi.typeof(c_type), value))
            elif how == "struct":
                struct = None if value is None else STRUCT_CLASSES[tag(kind)].of(value)
                alive.append(struct)
                arguments.append(ffi.NULL if value is None else struct.to_c())
            elif how == "numbers":
                pointer, kept, _ = to_array(kind, value)
                alive.append(kept)
                arguments.append(pointer)
            elif how == "array":
                pointer, kept, count = to_array(kind, value)
                alive.append(kept)
                arguments += [pointer, count]
            elif how == "one":
                out = STRUCT_CLASSES[tag(kind)]() if tag(kind) in STRUCT_CLASSES else ffi.new(c_type)
                outputs.append((out, kind))
                arguments.append(out.to_c() if tag(kind) in STRUCT_CLASSES else out)
            elif how == "as many":
                dtype = dtype_of(kind)
                out = np.zeros((count, *dtype.shape), dtype.base)
                outputs.append((out, None))
                arguments.append(ffi.cast(c_type, out.ctypes.data))
            elif how == "many":
                return self._many(arguments, kind, values)
            elif how == "size":
                arguments.append(ffi.sizeof(kind))
        result = self.call(*arguments)
        return self._returned(result, outputs)

    def _returned(self, result, outputs):
        if self.result == "int32_t":
            return bool(result)
        if self.result == "const char*" or self.result.startswith("const char"):
            return ffi.string(result).decode() if result != ffi.NULL else None
        if self.result != "taut_result":
            return result
        check(result)
        found = []
        for out, kind in outputs:
            if kind is None or tag(kind) in STRUCT_CLASSES:
                found.append(out)
            else:
                value = from_c(kind, out[0])
                found.append(bool(value) if "_is_" in self.name else value)
        return None if not found else found[0] if len(found) == 1 else tuple(found)

    def _many(self, arguments, kind, values):
        """An array of as many as there are."""
        row = _ROWS.get(self.name, 1)
        size = [ffi.sizeof(kind)] if self.plan[-1][0] == "size" else []
        count = ffi.new("uint32_t*")
        capacity, block = 0, ffi.NULL
        while True:
            result = self.call(*arguments, block, capacity, count, *size)
            if ERROR_TOO_SMALL != result:
                break
            capacity = count[0]
            block = ffi.new(f"{tag(kind)}[]", max(1, capacity * row))
        check(result)
        if tag(kind) in HANDLES:
            return [HANDLES[tag(kind)](block[i].bits) for i in range(count[0])]
        found = array_of(kind, block, count[0] * row)
        return found.reshape(-1, row) if row > 1 else found


ERROR_TOO_SMALL = 7  # TAUT_TOO_SMALL


def _public():
    """name -> (result, parameters) as a C program sees them, but for _init functions, which structs call."""
    for name, (result, parameters) in FUNCTIONS.items():
        plain = name[:-len("_sized")] if name.endswith("_sized") else name
        if not plain.endswith("_init") and plain not in BY_HAND:
            yield plain, result, parameters


def attach(module):
    """Puts each function where it belongs: on a handle, on a def that it changes, or into the module."""
    for name, result, parameters in _public():
        function = Function(name, result, parameters)
        first, first_name = parameters[0] if parameters else ("void", "")
        if first in HANDLES and name.startswith(first + "_") or (name, first) == ("taut_collider_distance", first):
            _method(HANDLES[first], name[len(first) + 1:], function)
        elif _bare(first) in STRUCT_CLASSES and first.endswith("*") and not first.startswith("const "):
            _changes(STRUCT_CLASSES[_bare(first)], name[len(_bare(first)) + 1:], function)
        else:
            module[name[len("taut_"):]] = function
            function.__doc__ = DOCS.get(name)


def _method(cls, short, function):
    def method(self, *values, **fields):
        return function(self, *values, **fields)

    method.__name__, method.__doc__ = short, DOCS.get(function.name)
    setattr(cls, short, method)


def _changes(cls, short, function):
    call = function.call

    def method(self, *values):
        check(call(self.to_c(), *(int(value) for value in values)))
        return self

    method.__name__, method.__doc__ = short, DOCS.get(function.name)
    setattr(cls, short, method)
