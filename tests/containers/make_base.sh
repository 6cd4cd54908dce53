#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# For machines that reach Debian's packages but no image registry: makes debian:bookworm-slim by debootstrap and gives it
# to podman under that name, so that the Dockerfile builds as it stands. As root. The image knows no package source;
# builds get this machine's (engine.py). Usage: make_base.sh NAME
set -euo pipefail
name=$1
root=$(mktemp -d /var/tmp/skinframe-base.XXXXXX)  # not where devices or programs are forbidden
trap 'rm -rf "$root" "$root.log"' EXIT
# awk may leave before cat has said all, and one of the two files may be absent: what counts is told below.
mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources 2>/dev/null |
  awk '/^URIs:/ {print $2; exit} /^deb / {for (i = 2; i <= NF; ++i) if ($i ~ /:\/\//) {print $i; exit}}' || true)
[ -n "$mirror" ] || { echo "make_base: no package source in /etc/apt" >&2; exit 1; }
debootstrap --variant=minbase --keyring=/usr/share/keyrings/debian-archive-keyring.gpg bookworm "$root" "$mirror" \
  >"$root.log" 2>&1 || { tail -5 "$root.log" >&2; exit 1; }
rm -rf "$root"/etc/apt/sources.list "$root"/var/log/*.log "$root"/var/cache/apt/*.bin "$root"/var/cache/apt/archives/*.deb \
  "$root"/var/lib/apt/lists/* "$root"/debootstrap
# What the registry's image is without and with: documentation and translations, but all licences.
find "$root"/usr/share/doc -type f ! -name copyright -delete
rm -rf "$root"/usr/share/{groff,info,lintian,man}/* "$root"/usr/share/locale/*/
printf 'path-exclude=/usr/share/%s/*\n' doc groff info lintian locale man >"$root/etc/dpkg/dpkg.cfg.d/slim"
printf 'path-include=/usr/share/%s\n' 'doc/*/copyright' locale/locale.alias >>"$root/etc/dpkg/dpkg.cfg.d/slim"
touch "$root/etc/apt/sources.list.d/debian.sources"  # where builds mount this machine's
printf '%s\n' 'Dir::Cache::pkgcache "";' 'Dir::Cache::srcpkgcache "";' 'Acquire::Languages "none";' \
  >"$root/etc/apt/apt.conf.d/docker-clean"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"
chmod 755 "$root/usr/sbin/policy-rc.d"
tar -C "$root" --numeric-owner -c . | podman import --quiet --change 'CMD ["bash"]' \
  --change 'ENV PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin' \
  - "$name" >/dev/null
