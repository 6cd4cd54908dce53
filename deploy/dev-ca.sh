#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A certificate authority for development and for a farm's own network, and the certificates that it signs.
#
#   dev-ca.sh DIR                                          server, worker and client
#   dev-ca.sh DIR --server farm.example --server 10.1.2.3  the server is also reached by these names and addresses
#   dev-ca.sh DIR --client north                           one more client; its name is its tenant
#
# DIR/ca.crt is for everybody; ca.key stays where it was made. Each NAME.crt goes with NAME.key to the one that it names.
# What is there is kept: run it again to add names. Keys are readable by any user so that containers can read them,
# and guarded by their folder, which only its owner may enter.
set -euo pipefail

usage() { sed -n '4,11s/^# \{0,1\}//p' "$0"; }
[ $# -ge 1 ] || { usage >&2; exit 2; }
case "$1" in -h|--help) usage; exit 0 ;; -*) usage >&2; exit 2 ;; esac
command -v openssl >/dev/null || { echo "dev-ca: openssl is needed" >&2; exit 1; }
dir=$1
shift
server_names=$(cat "$dir/server.names" 2>/dev/null || echo DNS:server,DNS:localhost,IP:127.0.0.1,IP:::1)
clients=(client)
while [ $# -gt 0 ]; do
  [ $# -ge 2 ] || { usage >&2; exit 2; }
  [[ $2 =~ ^[A-Za-z0-9.:-]+$ ]] || { echo "dev-ca: \"$2\" is no name or address" >&2; exit 2; }
  case "$1" in
    --server)
      kind=DNS
      [[ $2 =~ ^[0-9.]+$ || $2 == *:* ]] && kind=IP
      [[ ,$server_names, == *",$kind:$2,"* ]] || server_names+=",$kind:$2" ;;
    --client)
      case "$2" in ca|server|worker) echo "dev-ca: \"$2\" is taken" >&2; exit 2 ;; esac
      clients+=("$2") ;;
    *) usage >&2; exit 2 ;;
  esac
  shift 2
done

mkdir -p "$dir"
chmod 700 "$dir"
cd "$dir"

new_key() { openssl genpkey -algorithm EC -pkeyopt ec_paramgen_curve:P-256 -out "$1" 2>/dev/null; }

if [ ! -s ca.crt ]; then
  (umask 077 && new_key ca.key)
  openssl req -x509 -new -key ca.key -sha256 -days 3650 -subj "/CN=skinframe development CA" \
    -addext basicConstraints=critical,CA:TRUE -addext keyUsage=critical,keyCertSign,cRLSign -out ca.crt
fi

# sign NAME ALTERNATIVE_NAMES USAGE
sign() {
  new_key "$1.key"
  chmod 444 "$1.key"
  openssl req -new -key "$1.key" -subj "/CN=$1" |
    openssl x509 -req -CA ca.crt -CAkey ca.key -CAcreateserial -sha256 -days 825 -out "$1.crt" -extfile <(
      printf 'basicConstraints=critical,CA:FALSE\nkeyUsage=critical,digitalSignature\n'
      printf 'subjectAltName=%s\nextendedKeyUsage=%s\n' "$2" "$3") 2>/dev/null
  echo "made $dir/$1.crt for $2"
}

# The server's is made anew when it is to carry other names.
if [ ! -s server.crt ] || [ "$(cat server.names 2>/dev/null)" != "$server_names" ]; then
  rm -f server.key
  sign server "$server_names" serverAuth
  echo "$server_names" >server.names
fi
[ -s worker.crt ] || sign worker DNS:worker clientAuth
for name in "${clients[@]}"; do
  [ -s "$name.crt" ] || sign "$name" "DNS:$name" clientAuth
done
