#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the model of the lease protocol with SPIN: every property holds, and every defect built into it is
# caught by some property. Needs spin and a C compiler.
#   check.sh [WORK_DIR]
set -euo pipefail
model="$(cd "$(dirname "$0")" && pwd)/lease.pml"
work="${1:-$(mktemp -d)}"
mkdir -p "$work" && cd "$work"
properties=(safe ends)

# verdict PROPERTY DEFECT...: "holds" or "fails"; ends the script when the checker itself did not come through.
verdict() {
  local property="$1"; shift
  local defects=("${@/#/-D}")
  spin -a ${defects[@]+"${defects[@]}"} "$model" >spin.log 2>&1 || { cat spin.log >&2; exit 2; }
  cc -O2 -w -DCOLLAPSE -DNFAIR=3 -o pan pan.c
  local fair=(); [ "$property" = ends ] && fair=(-f)  # a safety property needs no fairness
  ./pan -a ${fair[@]+"${fair[@]}"} -m1000000 -N "$property" >pan.log 2>&1  # 0 also when the property fails: the log tells
  grep -q "max search depth too small" pan.log && { echo "check.sh: the search depth is too small" >&2; exit 2; }
  if grep -q "errors: 0" pan.log; then echo holds
  elif grep -Eq "errors: [1-9]" pan.log; then echo fails
  else cat pan.log >&2; exit 2; fi
}

bad=0
for property in "${properties[@]}"; do
  found=$(verdict "$property")
  states=$(awk '/states, stored/ {print $1; exit}' pan.log)
  echo "the protocol: $property $found ($states states)"
  [ "$found" = holds ] || bad=1
done

# A defect, and a property that must fail with it. Assertions fail with any property.
while read -r defect property; do
  found=$(verdict "$property" "$defect")
  echo "with $defect: $property $found"
  [ "$found" = fails ] || bad=1
done <<'DEFECTS'
NO_FENCE safe
TOKEN_PER_PROCESS safe
ACK_BEFORE_COMMIT safe
NO_REQUEST_ID safe
QUEUE_IN_MEMORY ends
LOSSES_DO_NOT_COUNT ends
CANCEL_IS_FORGOTTEN safe
UNDELIVERED_FORGETS safe
NO_CHECKPOINT_FENCE safe
CHECKPOINT_IS_LEFT safe
DEFECTS
[ "$bad" = 0 ] || { echo "check.sh: not as it should be" >&2; exit 1; }
echo "the protocol holds, and every defect is caught"
