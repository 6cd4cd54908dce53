#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Configures and builds Release into build/release. Usage: build.sh [TARGET ...]; quick when nothing changed.
# SKINFRAME_PRESET names another preset, and its folder in build/.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${SKINFRAME_PRESET:-release}
# With a compiler cache: what was compiled in one clone, or in this one for a test, serves another and the images.
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD}
unset LC_ALL LC_CTYPE LC_MESSAGES
export LANG=C.UTF-8  # the cache tells locales apart

# A geometry file needs up to 2 GB to compile: never more jobs than memory allows.
memory_gb=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo)
jobs=$(nproc)
[ $((memory_gb / 2)) -lt "$jobs" ] && jobs=$((memory_gb / 2))
[ "$jobs" -lt 1 ] && jobs=1

mkdir -p build
cmake --preset "$preset" >build/configure.log 2>&1 || { cat build/configure.log >&2; exit 1; }
targets=()
[ $# -gt 0 ] && targets=(--target "$@")
cmake --build "build/$preset" --parallel "$jobs" "${targets[@]}"
