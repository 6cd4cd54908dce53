#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Everything secret that compose.yaml needs, in deploy/secrets: certificates (dev-ca.sh, which gets the arguments) and
# the database's password. What is there is kept.
set -euo pipefail
cd "$(dirname "$0")"
./dev-ca.sh secrets "$@"
if [ ! -s secrets/database-password ]; then
  openssl rand -hex 24 >secrets/database-password
fi
# For the server, as a service file of libpq. Secrets are mounted with the modes that they have here.
cat >secrets/database-service <<END
[skinframe]
host=database
user=skinframe
dbname=skinframe
password=$(cat secrets/database-password)
END
chmod 444 secrets/database-password secrets/database-service
