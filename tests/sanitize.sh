#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The worker under AddressSanitizer and UndefinedBehaviorSanitizer: the mesh readers' tests, hostile files among them; one
# body through a whole job with everything that a job can have (optimiser, verification, drain holes, supports, loads,
# orientation); then every bad file of the corpus and as many good ones as time allows through the whole job process without
# optimising, small.
# A finding ends the program that has it, and this script with 1; so does a job that ends without an outcome, or that leaves
# a file anywhere but in its folder. Files that time did not allow are named at the end.
# Not covered: agent, server, client, check, render; memory that leaks. Not part of tests/run.sh.
# Usage: [SKINFRAME_MODELS=DIR] [SIZE=20] [MINUTES=30] tests/sanitize.sh [build] [mesh] [whole] [corpus] [FILE...]
#   (default: build mesh whole corpus; MINUTES: of whole and corpus. FILE: this mesh too)
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
build=${BUILD:-$root/build/asan}
models=${SKINFRAME_MODELS:-$root/../shared/models}
# Leaks are not looked for: a job's process ends by exit, and libraries keep what they have. OpenVDB and TBB mix
# allocators across libraries that are not instrumented.
export ASAN_OPTIONS=detect_leaks=0:alloc_dealloc_mismatch=0:abort_on_error=0:hard_rss_limit_mb=4096
export UBSAN_OPTIONS=print_stacktrace=1
steps='' files=() whole=''
for word in "${@:-build mesh whole corpus}"; do
  if [ -f "$word" ]; then files+=("$(realpath "$word")"); else steps+=" $word"; fi
done

if [[ "$steps " == *" build "* ]]; then
  [ -e "$build/build.ninja" ] || cmake --preset asan -S "$root" -B "$build" > /dev/null
  ninja -C "$build" -j "${JOBS:-2}" skinframe_sanitize_job skinframe_test_worker_mesh
fi
if [[ "$steps " == *" mesh "* ]]; then
  "$build/bin/skinframe_test_worker_mesh" --gtest_brief=1
fi
[[ "$steps " == *" whole "* ]] && whole=$models/good/bob_small.ply && files+=("$whole")
[[ "$steps " == *" corpus "* ]] && mapfile -t -O "${#files[@]}" files < <(ls "$models"/bad/* && ls -Sr "$models"/good/*)

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/tmp" "$scratch/home" "$scratch/cwd"

powder='"id": "powder", "process": "powder", "min_radius_mm": 0.5, "tray_mm": [457, 380, 330], "max_internal_radius_mm": 5,
  "printable_length": null, "build_direction": "up", "neck_diameter_mm": null'
extrusion='"id": "extrusion", "process": "extrusion", "min_radius_mm": 0.4, "tray_mm": [285, 153, 155],
  "max_internal_radius_mm": 5, "drain_holes": null, "build_direction": "up", "neck_diameter_mm": 0.8,
  "printable_length": {"points": [{"angle_deg": 45, "length_mm": null}, {"angle_deg": 90, "length_mm": 10}],
                       "is_default": true, "source": "default"}'
material='{"id": "pa", "tensile_modulus_mpa": 1586, "shear_modulus_mpa": 1387, "tensile_strength_mpa": 43,
  "shear_strength_mpa": 48, "slenderness": 60, "density_g_cm3": 1.15, "price_per_kg": null}'

# write_job FOLDER NAME LOADS PRINTERS OPTIONS
write_job() {
  cat > "$1/job.json" <<JSON
{"job_id": "sanitize", "mesh_path": "$1/mesh", "mesh_name": "$2", "threads": 2, "loads": [$3], "printers": [$4],
 "options": {"up": "z", "balance": "auto", "internal_nodes": null, "voxel_mm": null, "order": "tight",
             "displacement_limit_mm": 0.05, "seed": 1, $5}}
JSON
}

findings=0 late=()
SECONDS=0
for file in "${files[@]}"; do
  if [ $SECONDS -gt $((${MINUTES:-30} * 60)) ]; then
    late+=("$(basename "$file")")
    continue
  fi
  job=$scratch/job began=$SECONDS
  rm -rf "$job"
  mkdir "$job"
  cp "$file" "$job/mesh"
  if [ "$file" = "$whole" ]; then
    whole='' # the corpus has it once more
    write_job "$job" "$(basename "$file")" '{"name": "side", "place": "top", "force_n": [2, 0, 0]}' \
      "{\"printer\": {$powder, \"drain_holes\": {\"diameter_mm\": 4, \"least_count\": 2, \"least_diameter_mm\": 2}},
        \"material\": $material}, {\"printer\": {$extrusion}, \"material\": $material}" \
      '"size_mm": 36, "skin_nodes": 60, "smooth": "on", "orient": "best", "no_optimize": false, "verify": true'
  else
    write_job "$job" "$(basename "$file")" "" \
      "{\"printer\": {$powder, \"drain_holes\": null}, \"material\": $material}" \
      "\"size_mm\": ${SIZE:-20}, \"skin_nodes\": null, \"smooth\": \"auto\", \"orient\": \"keep\", \"no_optimize\": true,
       \"verify\": false"
  fi
  touch "$scratch/stamp"
  code=0
  (cd "$scratch/cwd" && TMPDIR=$scratch/tmp HOME=$scratch/home timeout 900 "$build/bin/skinframe_sanitize_job" "$job") \
    > "$scratch/words" 2>&1 || code=$?
  if [ "$code" != 0 ] || [ ! -e "$job/outcome.json" ] || grep -qE 'runtime error|Sanitizer' "$scratch/words"; then
    findings=$((findings + 1))
    echo "finding: $file ended with $code"
    cat "$scratch/words"
  fi
  stray=$(find "$models" "$root/worker" "$root/tests" "$scratch/cwd" "$scratch/home" "$scratch/tmp" \
    -newer "$scratch/stamp" -type f)
  if [ -n "$stray" ]; then
    findings=$((findings + 1))
    echo "finding: $file left files outside of its folder:"
    echo "$stray"
  fi
  echo "$(basename "$file"): $(grep -o '"state": *"[A-Z]*"' "$job/outcome.json" 2> /dev/null | head -1), $((SECONDS - began)) s"
done
[ ${#late[@]} = 0 ] || echo "not run within ${MINUTES:-30} minutes: ${late[*]}"
[ "$findings" = 0 ] || { echo "$findings findings"; exit 1; }
echo "no finding in $((${#files[@]} - ${#late[@]})) files"
