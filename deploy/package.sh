#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the programs without tests and packs them as Debian packages. Usage: package.sh DIR
set -euo pipefail
out=$(mkdir -p "$1" && cd "$1" && pwd)
cd "$(dirname "$0")/.."
./deploy/install-packages.sh package
SKINFRAME_PRESET=package ./deploy/build.sh
cd build/package
cpack -G DEB -B "$out" >"$out.log" || { cat "$out.log" >&2; exit 1; }
rm -rf "$out.log" "$out/_CPack_Packages"
ls -l "$out"
