#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What a second printer costs: one job for two printers over the slower of the two alone, in one run, each run a whole
# job from file to files.
#   ./tests/bench/printers.sh [MESH] [--expect RATIO]    MESH: else the sample hanging-ball; 140 mm, 20 N at its top
# SKINFRAME_BIN: where the programs are, build/release/bin otherwise. With --expect the exit code is 1 above that ratio.
set -euo pipefail

here=$(cd "$(dirname "$0")/../.." && pwd)
bin=${SKINFRAME_BIN:-$here/build/release/bin}
printers=(sinterstation-hiq makerbot-replicator-2)
mesh= expect=
while [ $# -gt 0 ]; do
  case $1 in
    --expect) expect=${2:?a ratio follows --expect}; shift 2 ;;
    -*) echo "printers.sh: unknown option $1" >&2; exit 2 ;;
    *) mesh=$1; shift ;;
  esac
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ -z "$mesh" ]; then
  mesh=$work/hanging-ball.stl
  "$bin/skinframe" sample hanging-ball --out "$mesh" >/dev/null
fi

# Wall and CPU seconds of one job, all its processes in it.
run() {
  local words=() seconds TIMEFORMAT='%R %U %S'
  for printer in "$@"; do words+=(--printer "$printer"); done
  rm -rf "$work/out"
  seconds=$({ time "$bin/skinframe" run "$mesh" --size 140 --load side:top:20,0,0 "${words[@]}" --out "$work/out" \
    >"$work/log" 2>&1 || touch "$work/failed"; } 2>&1)
  if [ -e "$work/failed" ]; then cat "$work/log" >&2; exit 1; fi
  echo "$seconds"
}

first=$(run "${printers[0]}")
second=$(run "${printers[1]}")
both=$(run "${printers[@]}")
echo "| printers | wall s | CPU s |"
echo "|---|--:|--:|"
awk -v names="${printers[0]};${printers[1]};both" -v expect="$expect" '
  { wall[NR] = $1; cpu[NR] = $2 + $3; split(names, name, ";"); printf "| %s | %.1f | %.1f |\n", name[NR], wall[NR], cpu[NR] }
  END {
    slower = wall[1] > wall[2] ? wall[1] : wall[2]; dearer = cpu[1] > cpu[2] ? cpu[1] : cpu[2]
    printf "| both over the slower | %.2f | %.2f |\n", wall[3] / slower, cpu[3] / dearer
    if (expect != "" && wall[3] > expect * slower) exit 1
  }' <<<"$first
$second
$both"
