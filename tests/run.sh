#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, runs all tests. Arguments go to ctest, for example: ./tests/run.sh -R worker.mesh
# The corpus tests find real meshes in SKINFRAME_MODELS (default ../shared/models beside the checkout); where CI=true
# and they are absent, they fail; elsewhere they are not registered and this script says so.
# SKINFRAME_CORPUS=full takes every model of the corpus at its full size through the whole job: half an hour more.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
export SKINFRAME_MODELS=${SKINFRAME_MODELS:-$here/../shared/models}
if [ ! -d "$SKINFRAME_MODELS" ]; then
  echo "run.sh: no model corpus at $SKINFRAME_MODELS: $([ "${CI:-}" = true ] && echo "its tests will fail" || echo "its tests are left out")" >&2
fi

"$here/deploy/install-packages.sh" tests
"$here/deploy/build.sh"
cd "$here/build/release"
exec ctest --output-on-failure --parallel "$(nproc)" --no-tests=error "$@"
