# SPDX-License-Identifier: Apache-2.0
"""Adds the stubs, generated from proto/, to the package: by protoc and gRPC's plugin (Debian: protobuf-compiler and
protobuf-compiler-grpc), or by PyPI's grpcio-tools where those are not there. Needs no network."""
import pathlib
import shutil
import subprocess
import sys

from setuptools import setup
from setuptools.command.build_py import build_py

PROTO = pathlib.Path(__file__).resolve().parents[2] / "proto"


class BuildWithStubs(build_py):
    def run(self):
        super().run()
        plugin = shutil.which("grpc_python_plugin")
        if plugin and shutil.which("protoc"):
            protoc = ["protoc", f"--plugin=protoc-gen-grpc_python={plugin}"]
        else:
            protoc = [sys.executable, "-m", "grpc_tools.protoc"]
        protos = sorted(str(path) for path in (PROTO / "skinframe" / "v1").glob("*.proto"))
        out = pathlib.Path(self.build_lib)
        subprocess.run([*protoc, f"-I{PROTO}", f"--python_out={out}", f"--grpc_python_out={out}", *protos], check=True)
        (out / "skinframe" / "v1" / "__init__.py").write_text("")


setup(cmdclass={"build_py": BuildWithStubs})
