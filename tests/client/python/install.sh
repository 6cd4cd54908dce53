#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The package can be built and installed without network: install.sh SOURCE SITE puts it into the folder SITE.
set -euo pipefail
rm -rf "$2"
wheels=$(mktemp -d)
trap 'rm -rf "$wheels"' EXIT
"$1/client/python/package.sh" "$wheels"
PIP_ROOT_USER_ACTION=ignore /usr/bin/python3 -m pip --disable-pip-version-check install --quiet --no-index --no-deps --target "$2" "$wheels"/*.whl
cd "$2"
PYTHONPATH=$2 /usr/bin/python3 -c 'import skinframe; skinframe.connect("localhost:1").close()'
