#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the package as a wheel, without network and without leavings in the source tree. Usage: package.sh DIR
# Needs Debian's python3-pip, python3-setuptools, python3-wheel and protobuf-compiler-grpc.
set -euo pipefail
out=$(mkdir -p "$1" && cd "$1" && pwd)
root=$(cd "$(dirname "$0")/../.." && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir "$tree/client"
cp -r "$root/proto" "$tree/proto"
cp -r "$root/client/python" "$tree/client/python"
/usr/bin/python3 -m pip --disable-pip-version-check wheel --quiet --no-index --no-build-isolation --no-deps \
  --wheel-dir "$out" "$tree/client/python"
