#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, runs all tests of ctest and, where containers can run, those in containers after
# them; where not, it says so. SKINFRAME_CONTAINERS=off leaves them out.
#   ./tests/run.sh -R worker.mesh                   only these; arguments go to ctest
#   ./tests/run.sh --containers                     only those in containers: images, faults on a network of their own
#   ./tests/run.sh --containers Faults              only these of them
#   SKINFRAME_FAULTS=extended ./tests/run.sh ...    more kills, and each fault in containers 20 times
# The corpus tests find real meshes in SKINFRAME_MODELS (default ../shared/models beside the checkout); where CI=true
# and they are absent, they fail; elsewhere they are not registered and this script says so.
# SKINFRAME_CORPUS=full takes every model of the corpus at its full size through the whole job: half an hour more.
set -euo pipefail

# Docker where it runs, else podman as root. 77: containers cannot run here, and it was said why. An interrupt is passed
# on, so that nothing stays behind.
in_containers() {
  if ! timeout 60 docker info >/dev/null 2>&1 && [ "$(id -u)" -eq 0 ]; then
    "$here/deploy/install-packages.sh" containers || echo "run.sh: podman could not be installed" >&2
  fi
  /usr/bin/python3 -B "$here/tests/containers/main.py" "$@" &
  local child=$! code=0
  trap 'kill -TERM "$child" 2>/dev/null || true' INT TERM
  wait "$child" || code=$?
  while kill -0 "$child" 2>/dev/null; do
    code=0
    wait "$child" || code=$?
  done
  trap - INT TERM
  return "$code"
}

here=$(cd "$(dirname "$0")/.." && pwd)
export SKINFRAME_MODELS=${SKINFRAME_MODELS:-$here/../shared/models}
if [ ! -d "$SKINFRAME_MODELS" ]; then
  echo "run.sh: no model corpus at $SKINFRAME_MODELS: $([ "${CI:-}" = true ] && echo "its tests will fail" || echo "its tests are left out")" >&2
fi

if [ "${1:-}" = --containers ]; then
  shift
  "$here/deploy/install-packages.sh" tests
  "$here/deploy/build.sh" skinframe skinframe-server skinframe-worker  # the images take it over from the compiler cache
  in_containers "$@"
  exit
fi
"$here/deploy/install-packages.sh" tests
"$here/deploy/build.sh"
tests=0
(cd "$here/build/release" && ctest --output-on-failure --parallel "$(nproc)" --no-tests=error "$@") || tests=$?
[ $# -gt 0 ] && exit $tests
containers=0
if [ "${SKINFRAME_CONTAINERS:-on}" = off ]; then
  echo "run.sh: the tests in containers were left out: SKINFRAME_CONTAINERS=off" >&2
elif [ "$SECONDS" -gt 3900 ]; then
  echo "run.sh: THE TESTS IN CONTAINERS WERE NOT RUN: the others took $((SECONDS / 60)) minutes already" >&2
else
  SKINFRAME_CONTAINERS_MINUTES=${SKINFRAME_CONTAINERS_MINUTES:-15} in_containers || containers=$?
fi
if [ $containers -eq 77 ]; then
  echo "run.sh: THE TESTS IN CONTAINERS WERE NOT RUN (see above)" >&2
  containers=0
fi
[ $tests -eq 0 ] && [ $containers -eq 0 ]
