#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The development CA: what it signs verifies, names are added and none is lost, what is there is kept.
# Usage: certificates_test.sh SOURCE_DIR
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
make_certificates() { "$1/deploy/dev-ca.sh" "$folder/ca" "${@:2}" >/dev/null; }
fail() { echo "$*" >&2; exit 1; }

make_certificates "$1"
[ "$(stat -c %a "$folder/ca")" = 700 ] || fail "others may enter the folder"
[ "$(stat -c %a "$folder/ca/ca.key")" = 600 ] || fail "others may read the authority's key"
kept=$(sha256sum "$folder/ca/worker.crt" "$folder/ca/ca.crt")
make_certificates "$1" --server farm.example --server 10.1.2.3
make_certificates "$1" --client north
[ "$kept" = "$(sha256sum "$folder/ca/worker.crt" "$folder/ca/ca.crt")" ] || fail "what was there was not kept"

cd "$folder/ca"
openssl verify -CAfile ca.crt -purpose sslserver -verify_hostname farm.example server.crt
openssl verify -CAfile ca.crt -purpose sslserver -verify_hostname localhost server.crt
openssl verify -CAfile ca.crt -purpose sslserver -verify_ip 10.1.2.3 server.crt
openssl verify -CAfile ca.crt -purpose sslclient -verify_hostname north north.crt
openssl verify -CAfile ca.crt -purpose sslclient -verify_hostname worker worker.crt
! openssl verify -CAfile ca.crt -purpose sslserver worker.crt 2>/dev/null || fail "a worker could be a server"
! "$1/deploy/dev-ca.sh" "$folder/ca" --client worker 2>/dev/null || fail "a client may call itself worker"
