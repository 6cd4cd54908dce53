#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The whole way once: installs what is missing, builds, sends a mesh through client, server, queue and worker
# (embedded SQLite store), prints the statistics and lets `skinframe check` judge the files.
#
#   ./deploy/demo.sh                       the sample body "hanging-ball", 200 mm, pushed at its top with 20 N, for the
#                                          powder printer
#   ./deploy/demo.sh FILE                  a mesh of yours, scaled to 200 mm
#   ./deploy/demo.sh FILE [run options]    with any option of `skinframe run`, for example
#                                          --printer makerbot-replicator-2 --size 140 --load side:top:20,0,0
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)

case "${1:-}" in
  -h|--help) sed -n '3,13s/^# \{0,1\}//p' "$0"; exit 0 ;;
esac
mesh=${1:-}
[ $# -gt 0 ] && shift
if [ -n "$mesh" ]; then
  [ -f "$mesh" ] || { echo "demo: no such file: $mesh" >&2; exit 3; }
  mesh=$(cd "$(dirname "$mesh")" && pwd)/$(basename "$mesh")
fi

"$here/deploy/install-packages.sh"
"$here/deploy/build.sh" skinframe skinframe-server skinframe-worker >&2
skinframe=$here/build/release/bin/skinframe
out=$here/demo-out
rm -rf "$out"
mkdir -p "$out"

options=("$@")
if [ -z "$mesh" ]; then
  mesh=$out/hanging-ball.stl
  "$skinframe" sample hanging-ball --out "$mesh"
  options+=(--load side:top:20,0,0)
fi
[[ " $* " == *" --printer"* ]] || options+=(--printer sinterstation-hiq)
[[ " $* " == *" --size"* ]] || options+=(--size 200)

result=$out/$(basename "${mesh%.*}")
"$skinframe" run "$mesh" "${options[@]}" --out "$result"
"$skinframe" check "$result"
echo
echo "The files are in $result"
