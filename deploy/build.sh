#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Configures and builds Release into build/release. Usage: build.sh [TARGET ...]; quick when nothing changed.
set -euo pipefail
cd "$(dirname "$0")/.."

# A geometry file needs up to 2 GB to compile: never more jobs than memory allows.
memory_gb=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo)
jobs=$(nproc)
[ $((memory_gb / 2)) -lt "$jobs" ] && jobs=$((memory_gb / 2))
[ "$jobs" -lt 1 ] && jobs=1

mkdir -p build
cmake --preset release >build/configure.log 2>&1 || { cat build/configure.log >&2; exit 1; }
targets=()
[ $# -gt 0 ] && targets=(--target "$@")
cmake --build build/release --parallel "$jobs" "${targets[@]}"
