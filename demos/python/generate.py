"""Makes the two modules of the binding that follow the headers: taut/_api.py, the types and functions for cffi, and
taut/_headers.py, what cffi does not keep: names and types of parameters, constants, comments.

By hand: python3 generate.py INCLUDE FOLDER."""
import pprint
import re
import sys
from pathlib import Path

from cffi import FFI


class Headers:
    """What <taut/taut.h> declares."""

    def __init__(self, include):
        self.include = Path(include)
        text = self._with_includes("taut/taut.h", set())
        self.constants = {name: _number(value)
                          for name, value in re.findall(r"^#define TAUT_(\w+) ([\d.]\S*)", text, re.M)}
        self.version = ".".join(str(self.constants["VERSION_" + part]) for part in ("MAJOR", "MINOR", "PATCH"))
        self.docs = _docs(text)
        text = re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)
        text = re.sub(r"^#ifdef __cplusplus$.*?^#endif$", "", text, flags=re.S | re.M)
        text = re.sub(r"^#.*$", "", text, flags=re.M)
        self.sized, text = _without_inline(text)
        self.cdef = re.sub(r"\[TAUT_(\w+)\]", lambda match: f"[{self.constants[match[1]]}]",
                           text.replace("TAUT_API ", ""))
        self.functions = {name: (" ".join(result.split()), _parameters(parameters))
                          for result, name, parameters in re.findall(
                              r"TAUT_API\s+([\w\s*]+?)\s*\b(taut_\w+)\(([^)]*)\);", text)}
        if text.count("TAUT_API") != len(self.functions):
            raise ValueError(f"{text.count('TAUT_API')} declarations, {len(self.functions)} of them understood")

    def _with_includes(self, name, seen):
        if name in seen:
            return ""
        seen.add(name)
        text = (self.include / name).read_text(encoding="utf-8")
        return re.sub(r"^#include <(.*?)>$",
                      lambda match: self._with_includes(match[1], seen) if match[1].startswith("taut/") else "",
                      text, flags=re.M)


def _number(text):
    text = text.rstrip("uUlL")
    return int(text, 0) if re.fullmatch(r"\d+|0x[\da-fA-F]+", text) else float(text.rstrip("fF"))


def _docs(text):
    """The comment before each function."""
    docs = {}
    for comment, name in re.findall(
            r"/\*\*((?:(?!\*/).)*)\*/\s*(?:TAUT_API|static inline)\s[\w\s*]*?\b(taut_\w+)\(", text, re.S):
        lines = (re.sub(r"^\s*\*? ?", "", line) for line in comment.splitlines())
        docs.setdefault(re.sub("_sized$", "", name), "\n".join(lines).strip())
    return docs


def _without_inline(text):
    """Of functions that pass on the size of the caller's struct: name -> (exported function, parameter sized)."""
    sized = {}

    def take_out(match):
        name, body = match[1], match[2]
        exported, argument = re.search(r"(taut_\w+)\(", body)[1], re.search(r"sizeof\(\*(\w+)\)", body)[1]
        if exported != name + "_sized":
            raise ValueError(f"{name} does not call {name}_sized: {body}")
        sized[name] = (exported, argument)
        return ""

    text = re.sub(r"static inline [\w\s*]*?\b(taut_\w+)\([^)]*\)\s*\{([^}]*)\}", take_out, text)
    return sized, text


def _parameters(text):
    """[(type, name)]; of an array the type is a pointer."""
    parameters = []
    for each in text.split(","):
        words = re.fullmatch(r"\s*(.*?)(\w+)(\[\d+\])?\s*", each, re.S)
        if each.strip() == "void":
            continue
        kind = re.sub(r"\s*\*\s*", "*", " ".join(words[1].split()))
        parameters.append((kind + ("*" if words[3] else ""), words[2]))
    return parameters


def write(headers, folder):
    """The two modules into a folder."""
    ffi = FFI()
    ffi.cdef(headers.cdef)
    ffi.set_source("taut._api", None)
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    ffi.emit_python_code(str(folder / "_api.py"))
    named = {"VERSION": headers.version, "CONSTANTS": headers.constants, "SIZED": headers.sized,
             "FUNCTIONS": headers.functions, "DOCS": headers.docs}
    (folder / "_headers.py").write_text(
        '"""Made from the headers by generate.py."""\n\n' +
        "\n".join(f"{name} = {pprint.pformat(value, width=118)}\n" for name, value in named.items()), encoding="utf-8")


if __name__ == "__main__":
    write(Headers(sys.argv[1]), sys.argv[2])
