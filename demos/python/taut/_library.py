"""The shared library, enums and errors."""
import ctypes.util
import enum
import os
import re

from ._api import ffi
from ._headers import FUNCTIONS, VERSION

_TYPES = sorted(ffi.list_types()[0])


def camel(c_name):
    """BodyDef of taut_body_def."""
    return "".join(word.capitalize() for word in c_name.split("_")[1:])


def tag(kind):
    """Name of a C type, of a struct or enum without that word."""
    return kind.cname.removeprefix("struct ").removeprefix("enum ")


def _open():
    named = os.environ.get("TAUT_LIBRARY")
    names = [named] if named else ["libtaut.so.0", ctypes.util.find_library("taut"), "libtaut.so"]
    refused = []
    for name in filter(None, names):
        try:
            return ffi.dlopen(name)
        except OSError as error:
            refused.append(str(error))
    raise ImportError("Taut's shared library is not found; TAUT_LIBRARY names its file: " + "; ".join(refused))


lib = _open()


def _is_enum(c_name):
    return ffi.typeof(c_name).kind == "enum"


def _members(c_name):
    """Without what all names begin with, and without the last one, which says how wide the type is."""
    values = {name: value for value, name in ffi.typeof(c_name).elements.items() if value != 0x7FFFFFFF}
    common = os.path.commonprefix([name + "_" for name in values])
    stem = common[: common.rfind("_") + 1] if len(values) > 1 else re.match(r"TAUT_", common)[0]
    return {name[len(stem):]: value for name, value in values.items()}


ENUMS = {name: enum.IntEnum(camel(name), _members(name), module="taut") for name in _TYPES if _is_enum(name)}
Result = ENUMS["taut_result"]


class Error(Exception):
    """A call was refused. result says why in a word, the text names function, field and value."""

    result = None


def _error_of(result):
    also = {"INVALID_ARGUMENT": (ValueError,), "OUT_OF_MEMORY": (MemoryError,)}.get(result.name, ())
    return type(result.name.title().replace("_", ""), (Error, *also), {"result": result, "__module__": "taut"})


ERRORS = {result: _error_of(result) for result in Result if result != Result.OK}


def check(result):
    """Raises the error of a result that is none of TAUT_OK."""
    if result != Result.OK:
        raise ERRORS[Result(result)](ffi.string(lib.taut_last_error()).decode())


def _check_version():
    found, mine = lib.taut_version(), [int(part) for part in VERSION.split(".")]
    if found // 100 < mine[0] * 100 + mine[1]:
        raise ImportError(f"the library is of version {found // 10000}.{found // 100 % 100}, this package of {VERSION}")


_check_version()
STRUCTS = [name for name in _TYPES if ffi.typeof(name).kind == "struct"]
EXPORTED = {name for name in FUNCTIONS}
