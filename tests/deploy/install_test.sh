#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# `cmake --install` puts programs that start and units that systemd takes, with little left to be exposed.
# Usage: install_test.sh BUILD_DIR
set -euo pipefail
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "$1" --prefix "$prefix" >/dev/null
for program in skinframe skinframe-server skinframe-worker; do
  "$prefix/bin/$program" --version
  test -s "$prefix/share/doc/$program/copyright"
  grep -q '^.SH DESCRIPTION' "$prefix/share/man/man1/$program.1"
done
bash -n "$prefix/share/bash-completion/completions/skinframe"
for unit in skinframe-server skinframe-worker; do
  file=$prefix/lib/systemd/system/$unit.service
  # systemd looks for a program without a folder where systems have them; here it is elsewhere.
  sed -i "s|^ExecStart=|ExecStart=$prefix/bin/|" "$file"
  systemd-analyze verify "$file"
  systemd-analyze security --offline=true --threshold=20 "$file" >/dev/null  # 2.0 of 10
  # Every option that the unit gives, or shows as an example, is one that the program knows.
  help=$("$prefix/bin/$unit" --help)
  for option in $(grep -o -- ' --[a-z-]*' "$file" | sort -u); do
    grep -qw -e "$option" <<<"$help" || { echo "$unit knows no $option" >&2; exit 1; }
  done
done
