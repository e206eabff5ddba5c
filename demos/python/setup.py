"""Installs from the tree: pip install --no-build-isolation demos/python. TAUT_INCLUDE: where the headers are, if not
beside it. The package loads libtaut.so as the system finds it, or the file that TAUT_LIBRARY names."""
import os
import sys
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import generate  # noqa: E402

INCLUDE = Path(os.environ.get("TAUT_INCLUDE", HERE.parent.parent / "include"))
HEADERS = generate.Headers(INCLUDE)


class BuildWithInterface(build_py):
    """Adds what is made from the headers."""

    def run(self):
        super().run()
        generate.write(HEADERS, Path(self.build_lib) / "taut")


setup(version=HEADERS.version, cmdclass={"build_py": BuildWithInterface})
