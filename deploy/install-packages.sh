#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian 12 packages that are missing: those to build and run; with "tests" those that only the tests
# need too, with "package" those that pack, with "containers" those that run containers, with "python" those that make and
# run the Python client. Silent and quick when all are there.
set -euo pipefail

build=(g++ cmake ninja-build pkg-config libeigen3-dev libcgal-dev libceres-dev libgrpc++-dev libprotobuf-dev
       protobuf-compiler protobuf-compiler-grpc libspdlog-dev libfmt-dev nlohmann-json3-dev libcli11-dev
       libsuitesparse-dev libmetis-dev libopenblas-dev liblapack-dev libopenvdb-dev libtbb-dev libboost-dev
       libboost-iostreams-dev libblosc-dev zlib1g-dev libsqlite3-dev libpqxx-dev libssl-dev
       libminizip-dev libexpat1-dev libspectra-dev prometheus-cpp-dev libpng-dev libfreetype-dev fonts-dejavu-core)
tests=(libgtest-dev libgmock-dev prusa-slicer calculix-ccx openssl coinor-libipopt-dev
       spin postgresql-15 util-linux ccache python3-pip python3-setuptools python3-wheel python3-grpcio
       python3-protobuf systemd)

package=(ccache dpkg-dev file)
containers=(podman runc golang-github-containernetworking-plugin-dnsname debootstrap debian-archive-keyring iptables
            podman-compose openssl python3-grpcio python3-protobuf python3-pip python3-setuptools python3-wheel
            protobuf-compiler protobuf-compiler-grpc)
python=(python3-venv python3-pip python3-setuptools python3-wheel python3-grpcio python3-protobuf protobuf-compiler
        protobuf-compiler-grpc)

wanted=("${build[@]}")
case "${1:-}" in
  tests) wanted+=("${tests[@]}") ;;
  package) wanted+=("${package[@]}") ;;
  containers) wanted=("${containers[@]}") ;;
  python) wanted=("${python[@]}") ;;
esac

missing=()
for package in "${wanted[@]}"; do
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install-packages: root or sudo is needed for: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} Debian packages: ${missing[*]}" >&2
"${as_root[@]}" apt-get update -q >&2
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}" >&2
