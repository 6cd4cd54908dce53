#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# PostgreSQL as a container's first process; an empty volume gets its database first.
set -eu
user=${POSTGRES_USER:-postgres}
database=${POSTGRES_DB:-$user}
if [ ! -d "$PGDATA" ]; then
  : "${POSTGRES_PASSWORD_FILE:?names the file with the password of $user}"
  # Renamed when whole: a first start that was cut off leaves no half of a database.
  rm -rf "$PGDATA.new"
  initdb --username="$user" --pwfile="$POSTGRES_PASSWORD_FILE" --auth=scram-sha-256 --encoding=UTF8 --locale=C.UTF-8 \
    -D "$PGDATA.new" >/dev/null
  echo "host all all all scram-sha-256" >>"$PGDATA.new/pg_hba.conf"
  if [ "$database" != postgres ]; then
    echo "CREATE DATABASE \"$database\"" | postgres --single -D "$PGDATA.new" postgres >/dev/null
  fi
  mv "$PGDATA.new" "$PGDATA"
fi
exec postgres -D "$PGDATA" -c listen_addresses='*' -c unix_socket_directories=/tmp "$@"
