#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fuzzes the mesh readers with libFuzzer under ASan and UBSan. Not part of tests/run.sh.
#   ./tests/fuzz/run.sh [read_mesh|read_3mf] [SECONDS] [FOLDER_WITH_SEEDS]
# read_mesh takes the bytes as a file, read_3mf as the model part of a package.
# Needs clang-14 and libclang-rt-14-dev. A finding is left beside the build as crash-*, timeout-* or oom-*; give that file
# to build/fuzz/fuzz_TARGET to see it again, and keep it as a test of the reader.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
target=${1:-read_mesh}
seconds=${2:-60}
seeds=${3:-${SKINFRAME_MODELS:-$root/../shared/models}}
build=$root/build/fuzz
for package in clang-14 libclang-rt-14-dev; do
  dpkg-query -W "$package" >/dev/null 2>&1 || { echo "fuzz: needs the package $package" >&2; exit 1; }
done
cmake -S "$here" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_BUILD_TYPE=None >/dev/null
ninja -C "$build" -j "${FUZZ_JOBS:-2}" >/dev/null
mkdir -p "$build/found-$target" "$build/seeds-$target"
# Small files make good seeds; large ones slow every run down.
if [ -d "$seeds" ]; then
  if [ "$target" = read_3mf ]; then
    find "$seeds" -name '*.3mf' -size -30k -exec sh -c 'unzip -p "$2" "3D/*.model" > "$1/$(basename "$2").model"' _ "$build/seeds-$target" {} ';'
  else
    find "$seeds" -type f -size -100k -exec cp -f {} "$build/seeds-$target/" ';'
  fi
  chmod -R u+w "$build/seeds-$target"
fi
cd "$build"
exec "./fuzz_$target" -max_total_time="$seconds" -max_len=100000 -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=512 \
  -dict="$here/mesh_formats.dict" -print_final_stats=1 "found-$target" "seeds-$target"
