#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The arrows of the house: who may include whom. The linker holds most of them; headers slip through it, not through here.
# Usage: arrows.sh SOURCE_DIR
set -euo pipefail
cd "$1"
failures=0

# forbid FOLDER PATTERN WHY: no source in FOLDER includes what PATTERN matches.
forbid() {
  local found
  [ -d "$1" ] || { echo "arrows: no folder $1"; failures=$((failures + 1)); return; }
  if found=$(grep -rnE "^[[:space:]]*#include [\"<]($2)" --include='*.h' --include='*.cpp' "$1"); then
    echo "arrows: $3:"
    echo "$found"
    failures=$((failures + 1))
  fi
}

forbid client '(worker|server)/' "the client knows proto/ only"
forbid server '(worker|client)/' "the server knows proto/ only"
forbid worker '(server|client)/' "the worker knows proto/ only"
forbid proto "(server|worker|client)/" "proto knows nobody"
for room in run sparse profile mesh raster solid skin stress drain frame mechanics structure optimize support problem export verify report sample pipeline check picture job metrics; do
  forbid "worker/$room" '(skinframe/v1|grpc|google/protobuf)' "only the agent sees gRPC and protobuf"
done
stages=(sparse profile mesh solid skin stress drain frame mechanics structure optimize support problem export verify report pipeline)
for i in "${!stages[@]}"; do
  for j in "${!stages[@]}"; do
    if [ "$j" -gt "$i" ]; then
      forbid "worker/${stages[i]}" "worker/${stages[j]}/" "${stages[i]} stands left of ${stages[j]}"
    fi
  done
done
forbid worker/check 'worker/(sparse|solid|skin|stress|drain|frame|mechanics|structure|optimize|problem|export|verify|report|pipeline)/' "the check shares no code with what it judges"
forbid worker/picture 'worker/(sparse|solid|skin|stress|drain|frame|mechanics|structure|optimize|support|problem|export|verify|report|sample|pipeline|check)/' "pictures are of exported files alone"
forbid worker/raster 'worker/(sparse|profile|solid|skin|stress|drain|frame|mechanics|structure|optimize|support|problem|export|verify|report|sample|pipeline|check|picture)/' "pixels do not know what they show"
for room in jobs store; do
  forbid "server/$room" 'server/api/' "$room stands left of api"
done
forbid server/jobs '(server/store|sqlite3|grpc)' "jobs are pure"
# Headers with CGAL's or OpenVDB's types are a room's own: no other room and no other's tests include them,
# but export may use skin's grids.
for header in $(grep -rlE '#include <(CGAL|openvdb)/' --include='*.h' worker); do
  room=$(basename "$(dirname "$header")")
  allowed="^(tests/)?worker/$room/"
  if [ "$room" = skin ]; then allowed="^(tests/)?worker/(skin|export)/"; fi
  if found=$(grep -rl "#include \"$header\"" worker tests | grep -vE "$allowed"); then
    echo "arrows: $header holds types of a geometry library and is included by: $found"
    failures=$((failures + 1))
  fi
done

echo "arrows: $failures broken"
[ "$failures" -eq 0 ]
