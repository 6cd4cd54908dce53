#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The worker under AddressSanitizer and UndefinedBehaviorSanitizer: the tests of its rooms, then every file of the corpus,
# the bad ones too, through a whole job without optimising; and whether a job writes anything but its own folder.
# Any finding ends the program that has it. Not part of tests/run.sh: the build takes half an hour, the runs as long.
# Usage: [SKINFRAME_MODELS=DIR] tests/sanitize.sh [build] [rooms] [corpus]     (default: all three)
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
build=$root/build/asan
export SKINFRAME_MODELS=${SKINFRAME_MODELS:-$root/../shared/models}
# Leaks are not looked for: a job's process ends by exit, and libraries keep what they have. OpenVDB and TBB mix
# allocators across libraries that are not instrumented.
export ASAN_OPTIONS=detect_leaks=0:alloc_dealloc_mismatch=0:abort_on_error=0
export UBSAN_OPTIONS=print_stacktrace=1
steps=${*:-build rooms corpus}

if [[ " $steps " == *" build "* ]]; then
  cmake --preset asan -S "$root" > /dev/null
  rooms=$(ninja -C "$build" -t targets all | grep -o '^skinframe_test_worker_[a-z_]*' | sort -u)
  # shellcheck disable=SC2086
  ninja -C "$build" -j "${JOBS:-2}" skinframe skinframe-server skinframe-worker $rooms
fi
if [[ " $steps " == *" rooms "* ]]; then
  # Oracles run programs of other licences; times of the optimiser are no question here.
  ctest --test-dir "$build" -R '^worker\.' -E '^worker\.oracle' --timeout 1200 --output-on-failure
fi
if [[ " $steps " == *" corpus "* ]]; then
  scratch=$(mktemp -d)
  trap 'rm -rf "$scratch"' EXIT
  mkdir "$scratch/tmp" "$scratch/home" "$scratch/cwd"
  findings=0
  while read -r file; do
    touch "$scratch/stamp"
    sleep 0.01  # of the clock that files are stamped by
    code=0
    (cd "$scratch/cwd" && TMPDIR=$scratch/tmp HOME=$scratch/home timeout 1200 "$build/bin/skinframe" run "$file" \
      --size "${SIZE:-40}" --printer sinterstation-hiq --no-optimize --out "$scratch/out") \
      > "$scratch/words" 2>&1 || code=$?
    # 0: made; 3: refused. Whatever else it ended by is a finding, and so is a sanitizer's word.
    if { [ "$code" != 0 ] && [ "$code" != 3 ]; } || grep -qE 'runtime error|AddressSanitizer|CRASHED' "$scratch/words"; then
      findings=$((findings + 1))
      echo "finding: $file ended with $code"
      cat "$scratch/words"
    fi
    stray=$(find "$SKINFRAME_MODELS" "$root/worker" "$root/tests" "$scratch/cwd" "$scratch/home" "$scratch/tmp" \
      -newer "$scratch/stamp" -type f)
    if [ -n "$stray" ]; then
      findings=$((findings + 1))
      echo "finding: $file left files outside of its folder:"
      echo "$stray"
    fi
    echo "$code $file"
    rm -rf "$scratch/out"
  done < <(find "$SKINFRAME_MODELS/good" "$SKINFRAME_MODELS/bad" -type f | sort)
  [ "$findings" = 0 ] || { echo "$findings findings"; exit 1; }
  echo "no finding"
fi
